#pragma once

#include <cstdint>

namespace vsplit::tools {

/// Starts to count what operator new hands out, from zero. The counting covers the whole program and
/// is off until then. Thread safe.
void start_heap_meter();

/// Stops counting and returns the largest number of bytes that were in use at once since the start,
/// as the allocator rounds them. Thread safe.
[[nodiscard]] std::uint64_t stop_heap_meter();

}  // namespace vsplit::tools
