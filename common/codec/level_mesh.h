#pragma once

#include "codec/grown_mesh.h"
#include "codec/refinement_mesh.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// A level's mesh in the order of its slots, which attributes are coded on. A corner is 4 * slot + k.
struct LevelMesh
{
    std::vector<Triangle> triangles;              ///< By slot.
    std::vector<std::array<Corner, 3>> opposite;  ///< Corner across the edge opposite to corner k.
    std::vector<std::array<std::int32_t, 3>> positions;  ///< By vertex, on the level's grid.

    /// Vertex at a corner.
    [[nodiscard]] std::uint32_t vertex(Corner corner) const
    {
        return triangles[static_cast<std::size_t>(corner >> 2)]
                        [static_cast<std::size_t>(corner & 3)];
    }

    /// Corner across the edge opposite to a corner; negative at the boundary.
    [[nodiscard]] Corner across(Corner corner) const
    {
        return opposite[static_cast<std::size_t>(corner >> 2)]
                       [static_cast<std::size_t>(corner & 3)];
    }
};

/// Copies the mesh of a level that splits made. Cost: linear.
[[nodiscard]] LevelMesh level_mesh(const RefinementMesh& mesh);

/// Copies the complete mesh that was grown. `faces`: with final vertex numbers. Cost: linear.
[[nodiscard]] LevelMesh level_mesh(
    std::span<const GrownFace> faces, std::span<const std::array<std::int32_t, 3>> positions
);

/// For each vertex one of its corners: where its fan of faces begins on a boundary, else the one with the
/// smallest number. Cost: linear.
[[nodiscard]] std::vector<Corner> first_corners(const LevelMesh& mesh);

/// The faces around a vertex, counter-clockwise.
struct Fan
{
    std::vector<Corner> corners;  ///< At the vertex, one a face.
    bool closed = false;          ///< The last face and the first one share an edge.
};

/// Walks the fan of a vertex from its first corner; `fan` is overwritten.
inline void walk_fan(const LevelMesh& mesh, Corner first, Fan& fan)
{
    fan.corners.clear();
    fan.closed = false;
    for (Corner corner = first; corner >= 0;)
    {
        fan.corners.push_back(corner);
        const Corner across = mesh.across(next_corner(corner));
        corner = across < 0 ? -1 : next_corner(across);
        if (corner == first)
        {
            fan.closed = true;
            return;
        }
    }
}

}  // namespace vsplit::codec
