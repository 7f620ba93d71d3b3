#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/edge_table.h"
#include "precompute/repair.h"

#include <cstdint>
#include <vector>

namespace vsplit::precompute {

/// First step of repair_mesh(): welds equal positions, drops degenerate and duplicate triangles and
/// every vertex that is then unused; the order of the others stays.
/// `mesh`: finite positions, indices in range. Fills welded_vertices, isolated_vertices,
/// degenerate_faces and duplicate_faces of its report. Cost: two sorts. Thread safe.
/// `result`: gets mesh and source faces; its importance, per vertex of `mesh` or empty, becomes that of
/// the result, a welded vertex having the largest.
void weld_and_clean(const IndexedMesh& mesh, RepairedMesh& result);

/// Part of the second step: joins the two half-edges of every edge that has exactly two, and of an edge
/// with more those whose faces go on smoothly in each other, unless the result would not be a manifold.
/// `mesh`: result of weld_and_clean(). Result: per half-edge the one it is joined to, or kNoHalfEdge.
/// Fills non_manifold_edges of `report`: edges with more than two faces. Thread safe.
[[nodiscard]] std::vector<HalfEdge> join_edges(const IndexedMesh& mesh, RepairReport& report);

/// Which faces belong together across edges, and which must turn round to agree.
struct Orientation
{
    std::vector<HalfEdge> opposite;      ///< Per half-edge the one it is joined to, or kNoHalfEdge.
    std::vector<std::uint8_t> reversed;  ///< Per face 1 when it must turn round.
    std::uint32_t components = 0;        ///< Sets of faces that are joined.
};

/// Second step: joins faces across edges as join_edges() does, spreads one direction over each
/// component (the one that most of its faces have; the first face's when they are equal), and cuts
/// the edges where that leaves a contradiction. Changes nothing in the mesh.
/// `mesh`: result of weld_and_clean(). Fills flipped_faces and non_manifold_edges of `report`.
/// Cost: linear but for EdgeTable. Thread safe.
[[nodiscard]] Orientation orient_faces(const IndexedMesh& mesh, RepairReport& report);

/// Third step: gives every fan of faces a vertex of its own. The fan of the smallest face keeps the
/// vertex, copies are appended in ascending order of their first face.
/// `mesh` is changed; result: RepairedMesh::stitches. Fills non_manifold_vertices and added_vertices
/// of `report`. Cost: linear. Thread safe.
[[nodiscard]] std::vector<std::uint32_t> split_fans(
    IndexedMesh& mesh, const Orientation& orientation, RepairReport& report
);

}  // namespace vsplit::precompute
