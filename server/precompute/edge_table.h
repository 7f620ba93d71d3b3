#pragma once

#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Directed edge number 3 * face + corner: it runs from that corner of the face to the next one.
using HalfEdge = std::uint32_t;

/// No half-edge.
inline constexpr HalfEdge kNoHalfEdge = 0xFFFFFFFFU;

/// The half-edge from the same face's next corner.
[[nodiscard]] constexpr HalfEdge next_in_face(HalfEdge half)
{
    return half % 3 == 2 ? half - 2 : half + 1;
}

/// All half-edges of a triangle list, those between the same two vertices side by side. Immutable
/// once built; thread safe then.
class EdgeTable
{
public:
    /// Builds the table. `triangles`: indices below `vertex_count`, none repeated in a triangle, at
    /// most 2^32 / 3 of them. Cost: linear, plus sorting the edges within each vertex.
    EdgeTable(std::span<const Triangle> triangles, std::size_t vertex_count);

    /// Calls `visit` once for every undirected edge, in ascending order of its vertices, with its
    /// half-edges in ascending order (std::span<const HalfEdge>).
    template <typename Visit>
    void for_each_edge(Visit&& visit) const
    {
        for (std::size_t begin = 0; begin < halves_.size();)
        {
            std::size_t end = begin + 1;
            while (end < halves_.size() && joins_previous_[end] != 0)
            {
                ++end;
            }
            visit(std::span(halves_).subspan(begin, end - begin));
            begin = end;
        }
    }

private:
    std::vector<HalfEdge> halves_;
    std::vector<std::uint8_t> joins_previous_;  ///< 1 when the edge is the previous half-edge's.
};

/// Fans of faces around vertices: corners (numbered as half-edges) of one vertex belong to the same
/// fan when their faces are linked across an edge at that vertex. Not thread safe.
class CornerFans
{
public:
    /// Starts with every corner on its own. `corner_count`: three times the number of faces.
    explicit CornerFans(std::size_t corner_count);

    /// Links two faces across the edge that `a` and `b` are the half-edges of.
    void link(std::span<const Triangle> triangles, HalfEdge a, HalfEdge b);

    /// Smallest corner of the fan that `corner` belongs to. Cost: nearly constant.
    [[nodiscard]] std::uint32_t find(std::uint32_t corner);

private:
    void unite(std::uint32_t a, std::uint32_t b);

    std::vector<std::uint32_t> parents_;
};

}  // namespace vsplit::precompute
