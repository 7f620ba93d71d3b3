#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

namespace vsplit::precompute {

/// Checks that a mesh is what repair_mesh() promises: a 2-manifold with boundary, consistently
/// oriented. Every vertex is used, no triangle repeats a vertex, every directed edge occurs at most
/// once, and the triangles around every vertex form one fan.
/// `mesh`: any mesh; positions do not matter. Result: nothing when all holds.
/// Errors: EmptyMesh, BadIndex, InputTooLarge, UnsupportedInput (with the offending vertex or face).
/// Cost: that of make_half_edge_mesh(), which finds out. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<void> check_manifold(const IndexedMesh& mesh);

}  // namespace vsplit::precompute
