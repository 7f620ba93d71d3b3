#pragma once

#include "mesh/indexed_mesh.h"

#include <cstdint>
#include <vector>

namespace vsplit::precompute {

/// Absolute curvature |k1| + |k2| of every vertex from a least-squares quadric (height) fit over the
/// vertex's neighbourhood.
/// `mesh`: a repaired mesh, model units; `threads`: worker threads, at least 1.
/// Result: one value a vertex, 1/length, finite and >= 0; 0 where a fit is impossible.
/// Cost: about one 5x5 solve a vertex. Deterministic for any number of threads. Thread safe.
[[nodiscard]] std::vector<float> quadric_curvature(const IndexedMesh& mesh, unsigned threads = 1);

/// Absolute curvature |k1| + |k2| of every vertex from the paper's fit: a bicubic B-spline surface by
/// least squares over an adaptive neighbourhood of 16 to 25 nearest neighbours.
/// Arguments, result, determinism as quadric_curvature(). Cost: one 16x16 solve a vertex.
/// Source: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", equations 1-16.
[[nodiscard]] std::vector<float> bspline_curvature(const IndexedMesh& mesh, unsigned threads = 1);

/// Tells which vertices are feature points: curvature above the mean over the neighbourhood.
/// `curvature`: one value a vertex of `mesh`. Result: one 0 or 1 a vertex.
/// Source: Wang, Yang, equation 17.
[[nodiscard]] std::vector<std::uint8_t> feature_points(
    const IndexedMesh& mesh, const std::vector<float>& curvature
);

/// Sparseness weight of every vertex: how thinly its surroundings are sampled, so that isolated detail
/// is not folded away first. Result: one positive value a vertex, mean about 1.
/// Source: Wang, Yang, equations 18 and 19.
[[nodiscard]] std::vector<float> sparseness_weights(const IndexedMesh& mesh);

}  // namespace vsplit::precompute
