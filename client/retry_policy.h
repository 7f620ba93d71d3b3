#pragma once

#include "core/error.h"

#include <chrono>
#include <optional>

namespace vsplit::client {

/// Decides whether and when a lost connection is made again: pauses of 100 ms, 200 ms, ... up to 5 s
/// (exponential back-off), until too many attempts in a row brought no byte. Not thread safe.
class RetryPolicy
{
public:
    /// `retries`: attempts after a loss; 0 never retries.
    explicit RetryPolicy(unsigned retries) : retries_(retries) {}

    /// Says how long to wait after a failed attempt, or nothing when it is time to give up.
    /// `code`: why it failed; only a lost connection, silence, and a server that is overloaded or
    /// shutting down are worth another attempt. `progress`: the attempt brought new bytes.
    [[nodiscard]] std::optional<std::chrono::milliseconds> next_pause(
        ErrorCode code, bool progress
    );

private:
    unsigned retries_;
    unsigned failures_ = 0;
};

}  // namespace vsplit::client
