#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::picture {

/// A side of a triangle.
struct TriangleSide
{
    std::array<std::uint32_t, 2> ends{};  ///< The smaller index first.
    std::uint32_t opposite = 0;           ///< The triangle's third vertex.

    /// Orders sides of one edge together.
    friend auto operator<=>(const TriangleSide&, const TriangleSide&) = default;
};

/// Lists the sides of all triangles, sorted, so that those of one edge follow each other. Vertices at
/// exactly the same place count as the first of them. Cost: sorting vertices and sides.
[[nodiscard]] std::vector<TriangleSide> sorted_sides(const IndexedMesh& mesh);

}  // namespace vsplit::picture
