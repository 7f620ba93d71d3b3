#include "retry_policy.h"

#include <algorithm>

namespace vsplit::client {
namespace {

constexpr std::chrono::milliseconds kFirstPause{100};
constexpr std::chrono::milliseconds kLongestPause{5000};
constexpr unsigned kMostDoublings = 6;  // beyond the longest pause

bool worth_retrying(ErrorCode code)
{
    return code == ErrorCode::ConnectionLost || code == ErrorCode::Timeout ||
           code == ErrorCode::Overloaded || code == ErrorCode::Cancelled;
}

}  // namespace

std::optional<std::chrono::milliseconds> RetryPolicy::next_pause(ErrorCode code, bool progress)
{
    failures_ = progress ? 1 : failures_ + 1;
    if (!worth_retrying(code) || failures_ > retries_)
    {
        return std::nullopt;
    }
    return std::min(kLongestPause, kFirstPause * (1U << std::min(failures_ - 1, kMostDoublings)));
}

}  // namespace vsplit::client
