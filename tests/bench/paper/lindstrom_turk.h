#pragma once

#include "mesh/indexed_mesh.h"

#include <cstddef>

namespace vsplit::bench {

/// Collapses edges into the best place by CGAL's simplification with its default cost and placement
/// (Lindstrom, Turk, "Fast and Memory Efficient Polygonal Simplification", 1998) until at most `faces`
/// faces are left or nothing can go.
/// `mesh`: from repair_mesh().
[[nodiscard]] IndexedMesh simplify_by_lindstrom_turk(const IndexedMesh& mesh, std::size_t faces);

}  // namespace vsplit::bench
