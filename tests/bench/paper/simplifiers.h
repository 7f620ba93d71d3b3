#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/metric.h"

#include <cstddef>

namespace vsplit::bench {

/// Folds vertices into neighbours in the order of one of vsplit's metrics, cheapest first, a twentieth
/// of the vertices at a time, until at most `faces` faces are left or nothing can go. What vsplit
/// encodes has the same prices and checks; it prefers, besides, collapses that code well in the finest
/// levels, and shows coarse levels with coarse positions.
/// `mesh`: from repair_mesh(). Result: the mesh with positions of the source.
[[nodiscard]] IndexedMesh simplify_by_metric(
    const IndexedMesh& mesh, precompute::Metric metric, std::size_t faces
);

/// How vertex clustering forms its clusters.
enum class Clustering
{
    Grid,          ///< Cells of a grid (Rossignac, Borrel 1993).
    FloatingCell,  ///< Balls around the most important vertices (Low, Tan 1997).
};

/// Joins the vertices of a cluster in its most important one, with clusters of the size that leaves as
/// many faces as possible but at most `faces`.
/// `mesh`: any triangles. Result: triangles that may meet in edges and vertices as they like.
[[nodiscard]] IndexedMesh simplify_by_clustering(
    const IndexedMesh& mesh, Clustering clustering, std::size_t faces
);

/// Collapses edges into the best place, in the order in which that adds least to an energy of distances
/// and springs (Hoppe 1996), until at most `faces` faces are left or nothing can go.
/// `mesh`: from repair_mesh().
[[nodiscard]] IndexedMesh simplify_by_energy(const IndexedMesh& mesh, std::size_t faces);

/// Folds vertices into neighbours by OpenMesh's decimater with its quadric module (Garland, Heckbert
/// 1997; half-edge collapses) until at most `faces` faces are left or nothing can go.
/// `mesh`: from repair_mesh().
[[nodiscard]] IndexedMesh simplify_by_open_mesh(const IndexedMesh& mesh, std::size_t faces);

/// Leaves out the vertices that no triangle uses; the order of the others stays.
[[nodiscard]] IndexedMesh without_unused_vertices(const IndexedMesh& mesh);

}  // namespace vsplit::bench
