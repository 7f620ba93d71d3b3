#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Marks the vertices that are copies of a cut one, so that they can stay where they are and the cut
/// does not open. `stitches`: as RepairedMesh's. Result: one flag a vertex; empty without stitches.
[[nodiscard]] std::vector<std::uint8_t> lock_copies(std::span<const std::uint32_t> stitches);

}  // namespace vsplit::precompute
