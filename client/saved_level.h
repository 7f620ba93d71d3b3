#pragma once

#include "core/result.h"
#include "refiner.h"

#include <filesystem>

namespace vsplit::client {

/// Writes the mesh that is shown as PLY, see write_ply(): with a vertex per wedge where the level has
/// normals, colours or texture coordinates to write; else the mesh alone, at the complete level with
/// cut vertices stitched. Error: IoError.
[[nodiscard]] Result<void> save_level(const std::filesystem::path& path, const Refiner& refiner);

}  // namespace vsplit::client
