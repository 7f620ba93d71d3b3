#include "link_shaper.h"

#include <algorithm>
#include <limits>

namespace vsplit::client {
namespace {

// What a link may deliver at once after a pause: it bounds the error that a late timer would cause
// without turning idle time into a burst that the real link could not deliver.
constexpr double kBurstSeconds = 0.1;
constexpr double kQuantumSeconds = 0.01;

}  // namespace

LinkShaper::LinkShaper(const LinkProfile& link, TimePoint now)
    : bytes_per_second_(link.bytes_per_second),
      latency_(link.latency),
      filled_at_(now),
      hold_until_(now)
{
}

void LinkShaper::hold_for_round_trip(TimePoint now)
{
    hold_until_ = now + latency_;
    filled_at_ = hold_until_;
    tokens_ = 0.0;
}

void LinkShaper::refill(TimePoint now)
{
    if (now <= filled_at_)
    {
        return;
    }
    const double seconds = std::chrono::duration<double>(now - filled_at_).count();
    const double capacity = std::max(1.0, bytes_per_second_ * kBurstSeconds);
    tokens_ = std::min(capacity, tokens_ + seconds * bytes_per_second_);
    filled_at_ = now;
}

std::size_t LinkShaper::readable(TimePoint now)
{
    if (now < hold_until_)
    {
        return 0;
    }
    if (bytes_per_second_ <= 0.0)
    {
        return std::numeric_limits<std::size_t>::max();
    }
    refill(now);
    return static_cast<std::size_t>(tokens_);
}

void LinkShaper::consume(std::size_t bytes)
{
    if (bytes_per_second_ > 0.0)
    {
        tokens_ -= static_cast<double>(bytes);
    }
}

LinkShaper::TimePoint LinkShaper::next_read(TimePoint now)
{
    const TimePoint earliest = std::max(now, hold_until_);
    if (bytes_per_second_ <= 0.0)
    {
        return earliest;
    }
    refill(now);
    const double quantum = std::max(1.0, bytes_per_second_ * kQuantumSeconds);
    const double missing = quantum - tokens_;
    if (missing <= 0.0)
    {
        return earliest;
    }
    // Rounded up: waking a moment early would find the bucket one byte short.
    const auto wait = std::chrono::ceil<std::chrono::microseconds>(
        std::chrono::duration<double>(missing / bytes_per_second_)
    );
    return std::max(earliest, filled_at_ + wait);
}

}  // namespace vsplit::client
