#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <filesystem>

namespace vsplit::assets {

/// Writes a mesh as binary little-endian PLY: float positions, 16-bit indices where they suffice.
/// Error: IoError; nothing is left behind then.
[[nodiscard]] Result<void> write_ply(const std::filesystem::path& path, const IndexedMesh& mesh);

}  // namespace vsplit::assets
