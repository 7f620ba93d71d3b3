#pragma once

#include "mesh/surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// A mesh whose vertices are the distinct combinations of a vertex and its values.
struct WedgeMesh
{
    std::vector<std::uint32_t> vertices;  ///< By wedge the vertex that it was.
    std::vector<std::uint32_t> values;    ///< By wedge one value of each attribute, in their order.
    std::vector<Triangle> triangles;      ///< Of wedges, in the order of `faces`.
};

/// Splits vertices where attributes have several values. Wedges are in the order in which the corners
/// reach them.
/// `triangles`: of the mesh; `attributes`: those that split; `faces`: the triangles to be taken;
/// `vertex_count`: the indices are smaller. Cost: linear in corners times wedges of a vertex. Deterministic.
/// Thread safe.
[[nodiscard]] WedgeMesh split_wedges(
    std::span<const Triangle> triangles,
    std::span<const SurfaceAttribute* const> attributes,
    std::span<const std::uint32_t> faces,
    std::size_t vertex_count
);

}  // namespace vsplit::precompute
