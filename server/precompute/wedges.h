#pragma once

#include "mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// The wedges of a mesh: sectors of the faces around a vertex between seams.
struct Wedges
{
    std::vector<Triangle> corners;  ///< By triangle the wedges at its corners, 0 .. count - 1.
    std::uint32_t count = 0;
};

/// Splits the corners round every vertex into wedges. An edge is a seam when a value differs at either
/// end between its two faces, or their groups do; a wedge is what lies between two seams, so that the
/// end of a seam inside of the surface has one.
/// `mesh`: 2-manifold with boundary, every vertex used; `tables`: by attribute and triangle numbers of
/// the values at its corners, the same for equal values; `groups`: one number a triangle, or empty.
/// Result: wedges numbered in the order in which the triangles meet them.
/// Cost: linear, about 60 bytes a triangle. Deterministic. Thread safe.
/// Source: Hoppe, "Efficient Implementation of Progressive Meshes", 1998, section 4 (wedges).
[[nodiscard]] Wedges split_wedges(
    const IndexedMesh& mesh,
    std::span<const std::span<const Triangle>> tables,
    std::span<const std::uint32_t> groups
);

}  // namespace vsplit::precompute
