#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <filesystem>

namespace vsplit::client {

/// Writes a mesh as binary little-endian PLY with double coordinates, so that every point of the
/// quantisation grid is kept exactly. The file appears complete or not at all. Error: IoError.
[[nodiscard]] Result<void> write_ply(const std::filesystem::path& path, const IndexedMesh& mesh);

}  // namespace vsplit::client
