#pragma once

#include "precompute/half_edge_mesh.h"

#include <cstdint>
#include <vector>

namespace vsplit::precompute {

/// Absolute curvature |k1| + |k2| of every vertex from a least-squares quadric (height) fit over the
/// vertex's neighbourhood.
/// `mesh`: from make_half_edge_mesh(), model units; `threads`: worker threads, at least 1.
/// Result: one value a vertex, 1/length, finite and >= 0; 0 where a fit is impossible.
/// Cost: about one 5x5 solve a vertex. Deterministic for any number of threads. Thread safe.
[[nodiscard]] std::vector<float> quadric_curvature(const HalfEdgeMesh& mesh, unsigned threads = 1);

/// Absolute curvature |k1| + |k2| of every vertex from the paper's fit: a bicubic B-spline surface by
/// least squares over an adaptive neighbourhood of 16 to 25 nearest neighbours; where the component
/// has fewer, or they do not determine the surface, the quadric fit over the same points.
/// Arguments, result, determinism as quadric_curvature(). Cost: one 16x16 solve a vertex.
/// Source: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", equations 1-16.
[[nodiscard]] std::vector<float> bspline_curvature(const HalfEdgeMesh& mesh, unsigned threads = 1);

/// How feature_points() decides.
struct FeatureOptions
{
    double ratio = 1.0;  ///< A feature's curvature exceeds this many times the local mean, >= 1.
    double flat = 1e-3;  ///< Never a feature: curvature below this share of the model's mean, >= 0.
};

/// Tells which vertices are feature points: curvature above the mean over the neighbourhood.
/// `mesh`: from make_half_edge_mesh(); `curvature`: one value a vertex of `mesh`, finite, >= 0; `threads`: at
/// least 1. Result: one 0 or 1 a vertex. Cost: one neighbourhood search a vertex. Deterministic for any
/// number of threads. Thread safe.
/// Source: Wang, Yang, equation 17.
[[nodiscard]] std::vector<std::uint8_t> feature_points(
    const HalfEdgeMesh& mesh,
    const std::vector<float>& curvature,
    const FeatureOptions& options = {},
    unsigned threads = 1
);

/// Sparseness weight of every vertex: how thinly its surroundings are sampled, so that isolated detail
/// is not folded away first. It is the mean distance to the adaptive neighbourhood in proportion to
/// the mean over the model.
/// `mesh`: from make_half_edge_mesh(); `threads`: at least 1. Result: one finite positive value a vertex, mean
/// about 1. Cost: one neighbourhood search a vertex. Deterministic for any number of threads. Thread
/// safe.
/// Source: Wang, Yang, equations 18 and 19.
[[nodiscard]] std::vector<float> sparseness_weights(const HalfEdgeMesh& mesh, unsigned threads = 1);

}  // namespace vsplit::precompute
