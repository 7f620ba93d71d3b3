#pragma once

#include "core/result.h"
#include "precompute/source_model.h"

#include <filesystem>

namespace vsplit::precompute {

/// Reads a model: OBJ with its materials, PLY, OFF, STL, OM (the latter three without attributes).
/// Polygons are triangulated as fans. Nothing is repaired; see repair_surface().
/// `path`: the format is told by the extension, then checked against the contents; images and material
/// libraries are read from its folder and below it, nowhere else.
/// Result: the triangles in file order, model units; attributes as tidy_attributes() leaves them;
/// textures whose image is missing or neither PNG nor JPEG are taken off and noted.
/// Errors: NotFound, IoError, UnsupportedInput, NotAMesh, BadCoordinate, BadIndex, InputTooLarge,
/// EmptyMesh. Counts that a file claims are checked against its size before anything is allocated.
/// Thread safe. Safe on untrusted input.
[[nodiscard]] Result<SourceModel> read_surface(const std::filesystem::path& path);

}  // namespace vsplit::precompute
