#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Orders points along a space-filling curve, so that neighbours in space are near in memory.
/// `positions`: V points, all finite. Result: the point that comes i-th. Equal points keep their order.
/// Cost: V log V. Deterministic. Thread safe.
/// Source: Morton, "A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing",
/// 1966.
[[nodiscard]] std::vector<std::uint32_t> locality_order(
    std::span<const std::array<double, 3>> positions
);

/// Renumbers a mesh: its vertices come in the given order, its triangles by their smallest vertex.
/// `order`: a permutation of the vertices; indices in `mesh` are in range. Cost: linear.
[[nodiscard]] IndexedMesh in_order(const IndexedMesh& mesh, std::span<const std::uint32_t> order);

/// Tells which triangle comes i-th when in_order() renumbers a mesh. The same arguments. Cost: linear.
[[nodiscard]] std::vector<std::uint32_t> triangle_order(
    std::span<const Triangle> triangles, std::span<const std::uint32_t> order
);

/// Brings one value a vertex, or whatever the order is of, into the given order; nothing stays nothing.
template <typename Value>
[[nodiscard]] std::vector<Value> in_order(
    std::span<const Value> values, std::span<const std::uint32_t> order
)
{
    std::vector<Value> result;
    result.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        result.push_back(values[order[i]]);
    }
    return result;
}

/// Returns for every vertex its place in the order.
[[nodiscard]] std::vector<std::uint32_t> inverse_order(std::span<const std::uint32_t> order);

}  // namespace vsplit::precompute
