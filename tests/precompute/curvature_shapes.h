#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/half_edge_mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vsplit::test {

/// A point of a surface over the unit square of parameters.
using ParametricSurface = std::function<std::array<double, 3>(double u, double v)>;

/// How sample_parametric() closes the parameter square.
struct Closing
{
    bool u = false;  ///< The u = 0 and u = 1 sides are one.
    bool v = false;  ///< The v = 0 and v = 1 sides are one.
};

/// Triangulates a parametric surface on a grid of `columns` x `rows` cells, diagonals alternating.
/// `jitter`: inner parameters move by up to this share of a cell, the same on every run.
[[nodiscard]] IndexedMesh sample_parametric(
    const ParametricSurface& surface,
    std::uint32_t columns,
    std::uint32_t rows,
    Closing closing = {},
    double jitter = 0.0
);

/// An icosahedron subdivided `levels` times and projected on the sphere of that radius round the
/// origin: 10 * 4^levels + 2 vertices.
[[nodiscard]] IndexedMesh make_sphere(double radius, int levels);

/// The half-edge mesh of a manifold; throws for anything else.
[[nodiscard]] precompute::HalfEdgeMesh link(const IndexedMesh& mesh);

/// The rotation about the axis (1, 2, 3) by 40 degrees, then a scaling, then a translation.
[[nodiscard]] IndexedMesh moved(
    const IndexedMesh& mesh, double scale, const std::array<double, 3>& translation
);

}  // namespace vsplit::test
