#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

namespace vsplit::precompute {

/// Calls `body(begin, end)` on consecutive ranges that cover 0 .. count - 1, one thread a range.
/// `threads`: at least 1; fewer are used when a range would hold less than about a thousand items.
/// Precondition: `body` writes only what belongs to its own range, hence the result does not depend
/// on `threads`. Returns when all ranges are done.
template <typename Body>
void parallel_ranges(std::uint32_t count, unsigned threads, const Body& body)
{
    constexpr std::uint32_t kSmallestRange = 1024;
    const std::uint32_t ranges =
        std::clamp<std::uint32_t>(count / kSmallestRange, 1, std::max(1U, threads));
    const auto bound = [count, ranges](std::uint32_t range) {
        return static_cast<std::uint32_t>(std::uint64_t{count} * range / ranges);
    };
    std::vector<std::jthread> workers;
    workers.reserve(ranges - 1);
    for (std::uint32_t range = 1; range < ranges; ++range)
    {
        workers.emplace_back([&body, begin = bound(range), end = bound(range + 1)] {
            body(begin, end);
        });
    }
    body(std::uint32_t{0}, bound(1));
}

}  // namespace vsplit::precompute
