#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <draco/mesh/mesh.h>

#include <memory>
#include <span>
#include <vector>

namespace vsplit::bench {

/// Codes a mesh with Draco as `draco_encoder -cl 10 -qp bits` does: edgebreaker, slowest and smallest.
/// Vertices at one place stay apart, so that exactly the given mesh is coded.
/// `mesh`: positions in model units, coded as floats. Error: Internal, when Draco refuses.
[[nodiscard]] Result<std::vector<char>> encode_with_draco(const IndexedMesh& mesh, int bits);

/// Decodes what encode_with_draco() made; does nothing else, so that it can be timed.
/// Error: Internal.
[[nodiscard]] Result<std::unique_ptr<draco::Mesh>> decode_with_draco(std::span<const char> bytes);

/// Copies positions and triangles out of a mesh that decode_with_draco() made.
[[nodiscard]] IndexedMesh copy_out(const draco::Mesh& mesh);

}  // namespace vsplit::bench
