#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// What repair_mesh() found and did; every count is of the input as it was read.
struct RepairReport
{
    std::uint32_t welded_vertices = 0;     ///< Merged into another one at exactly its position.
    std::uint32_t isolated_vertices = 0;   ///< Dropped: no triangle uses them.
    std::uint32_t degenerate_faces = 0;    ///< Dropped: an index repeats (after welding).
    std::uint32_t duplicate_faces = 0;     ///< Dropped: the same three vertices as an earlier one.
    std::uint32_t flipped_faces = 0;       ///< Turned round to agree with their neighbours.
    std::uint32_t non_manifold_edges = 0;  ///< Cut: more than two faces, or not orientable.
    std::uint32_t non_manifold_vertices = 0;  ///< Cut: several fans of faces met in one vertex.
    std::uint32_t added_vertices = 0;         ///< Copies that the cutting made.

    /// True when the input was taken over as it was.
    [[nodiscard]] bool clean() const;
};

/// A mesh that the encoder accepts, and how it came about.
struct RepairedMesh
{
    IndexedMesh mesh;  ///< 2-manifold with boundary, consistently oriented, every vertex used.
    /// Per vertex of `mesh` the smallest vertex cut from the same source vertex (itself if it was
    /// not cut); empty when nothing was cut.
    std::vector<std::uint32_t> stitches;
    /// Per vertex of `mesh` the largest importance among the input vertices that became it; empty
    /// when none was given.
    std::vector<float> importance;
    /// Per triangle of `mesh` the one of the input that it was; they ascend.
    std::vector<std::uint32_t> source_faces;
    /// Per triangle of `mesh` 1 when it was turned round: its second corner was the third of the
    /// input's triangle, and its third the second.
    std::vector<std::uint8_t> turned;
    RepairReport report;
    std::uint32_t components = 0;
    std::uint32_t boundary_edges = 0;
};

/// Makes any indexed triangles a 2-manifold with boundary: welds equal positions, drops degenerate and
/// duplicate faces and isolated vertices, orients by flood fill (keeping the majority's direction in
/// each component), cuts non-manifold edges and vertices into fans.
/// `mesh`: any triangles, model units. Order of vertices and triangles is kept where they survive.
/// `importance`: one number for each vertex of `mesh` that is to follow it, or empty.
/// Errors: EmptyMesh when no triangle is left, BadCoordinate, BadIndex, InputTooLarge,
/// UnsupportedInput (`importance` has another length), Internal (the result failed its own check).
/// Cost: linear but for one sort. Deterministic. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<RepairedMesh> repair_mesh(
    const IndexedMesh& mesh, std::span<const float> importance = {}
);

}  // namespace vsplit::precompute
