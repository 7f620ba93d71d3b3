#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Codes which vertices of the complete mesh are one vertex in the source mesh.
/// `stitches`: by vertex of the plan the representative of its source vertex; `sources`: by vertex of the stream its
/// vertex in the plan; `positions`: by vertex of the plan, on the grid.
/// Result: the contents of a Stitch chunk. Cost: n log n. Deterministic. Thread safe.
[[nodiscard]] std::vector<std::byte> encode_stitches(
    std::span<const std::uint32_t> stitches,
    std::span<const std::uint32_t> sources,
    std::span<const std::array<std::int32_t, 3>> positions
);

}  // namespace vsplit::codec
