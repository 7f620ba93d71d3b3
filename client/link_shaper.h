#pragma once

#include "link_profile.h"

#include <chrono>
#include <cstddef>

namespace vsplit::client {

/// Decides when and how many real bytes may be taken from the socket: a token bucket for the rate
/// and a hold for the round trip. The clock is an argument, so tests need not wait. Not thread safe.
/// Source of the token bucket: Turner, "New Directions in Communications", 1986.
class LinkShaper
{
public:
    /// A point in time on the clock that never jumps.
    using TimePoint = std::chrono::steady_clock::time_point;

    /// Starts with an empty bucket at `now`.
    LinkShaper(const LinkProfile& link, TimePoint now);

    /// Notes that something was sent while nothing was on its way here: the answer cannot be read
    /// before one latency has passed, and then comes at the link's rate.
    void hold_for_round_trip(TimePoint now);

    /// Bytes that may be taken from the socket at `now`; the maximum of size_t on an unlimited link.
    [[nodiscard]] std::size_t readable(TimePoint now);

    /// Counts bytes taken at `now`. Precondition: bytes <= readable(now).
    void consume(std::size_t bytes);

    /// The first time at which a read is worth while: the hold is over and about 10 ms of data (or
    /// one byte) have come down the link. Not before `now`.
    [[nodiscard]] TimePoint next_read(TimePoint now);

private:
    void refill(TimePoint now);

    double bytes_per_second_ = 0.0;
    std::chrono::milliseconds latency_{0};
    double tokens_ = 0.0;
    TimePoint filled_at_;
    TimePoint hold_until_;
};

}  // namespace vsplit::client
