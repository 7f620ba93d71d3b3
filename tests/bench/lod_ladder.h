#pragma once

#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace vsplit::bench {

/// Levels of detail of one mesh, each made for itself, from the whole mesh (first) to the coarsest.
class LodLadder
{
public:
    virtual ~LodLadder() = default;

    /// Number of levels, at least 1.
    [[nodiscard]] virtual std::size_t size() const = 0;

    /// The level's mesh, model units; a coarse level may have no triangle. Precondition: index < size().
    [[nodiscard]] virtual const IndexedMesh& level(std::size_t index) = 0;
};

/// Numbers of triangles from `triangles` down to 8, each `ratio` times the one before (0 < ratio < 1).
[[nodiscard]] std::vector<std::size_t> ladder_targets(std::size_t triangles, double ratio);

/// Levels by meshopt_simplify with default options, without an error limit; made when they are asked for.
[[nodiscard]] std::unique_ptr<LodLadder> make_meshopt_ladder(const IndexedMesh& mesh, double ratio);

/// Levels by CGAL's edge collapse with its default cost and placement (Lindstrom and Turk, "Fast and
/// Memory Efficient Polygonal Simplification", 1998), all taken from one run.
/// `mesh`: a 2-manifold with boundary, consistently oriented.
[[nodiscard]] std::unique_ptr<LodLadder> make_lindstrom_turk_ladder(
    const IndexedMesh& mesh, double ratio
);

}  // namespace vsplit::bench
