#pragma once

#include "precompute/half_edge_mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// A vertex's surroundings in its own frame, ready for a fit: the vertex is the origin, z the normal,
/// and lengths are divided by `radius`, so that every |coordinate| is at most 1.
struct LocalPatch
{
    static constexpr std::size_t kMostPoints = 25;

    std::array<Eigen::Vector3d, kMostPoints>
        points;  ///< The neighbours; x, y in the tangent plane.
    std::size_t point_count = 0;
    double radius = 0.0;  ///< Distance of the farthest neighbour, model units, > 0.
};

/// Returns the normal of every vertex: the area-weighted mean of its triangles' normals, unit length,
/// or zero where the triangles are degenerate or cancel.
/// Cost: linear.
[[nodiscard]] std::vector<Eigen::Vector3d> vertex_normals(const HalfEdgeMesh& mesh);

/// Expresses `neighbours` (at most LocalPatch::kMostPoints) in the frame of `vertex`.
/// The x axis points to the projection of the vertex's first neighbour, so that the frame turns with
/// the model (any other axis is taken where that lies along the normal). Result: false, with `patch`
/// undefined, where there is no frame (no normal, coincident points, overflow).
[[nodiscard]] bool make_patch(
    const HalfEdgeMesh& mesh,
    const std::vector<Eigen::Vector3d>& normals,
    std::uint32_t vertex,
    std::span<const std::uint32_t> neighbours,
    LocalPatch& patch
);

/// First and second derivatives of a surface at one point.
struct SurfaceDerivatives
{
    Eigen::Vector3d u, v, uu, uv, vv;
};

/// Returns |k1| + |k2| of a surface at a point from its derivatives; 0 where the surface is singular.
/// Source: do Carmo, "Differential Geometry of Curves and Surfaces", 1976, section 3-3; equations
/// 10-16 of Wang, Yang.
[[nodiscard]] double absolute_curvature(const SurfaceDerivatives& derivatives);

/// Returns |k1| + |k2| at the origin of a least-squares quadric height field through the origin,
/// in units of 1 / patch.radius. Never fails: a weak Tikhonov term decides what the points do not.
/// Cost: one 5x5 Cholesky solve.
[[nodiscard]] double quadric_fit(const LocalPatch& patch);

/// Turns a fit's result into a curvature in 1/length that is finite and >= 0.
[[nodiscard]] float to_curvature(double fitted, double radius);

}  // namespace vsplit::precompute
