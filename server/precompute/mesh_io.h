#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <filesystem>

namespace vsplit::precompute {

/// Reads a mesh file: OBJ, PLY (ascii, both byte orders, triangle strips), OFF, STL (ascii, binary),
/// OM (OpenMesh), GLB and glTF 2.0.
/// Polygons are triangulated as fans. Nothing is repaired; see repair_mesh().
/// `path`: the format is told by the extension, then checked against the contents.
/// Result: the triangles in file order, model units.
/// Errors: NotFound, IoError, UnsupportedInput, NotAMesh, BadCoordinate, BadIndex, InputTooLarge,
/// EmptyMesh. Counts that a file claims are checked against its size before anything is allocated.
[[nodiscard]] Result<IndexedMesh> read_mesh(const std::filesystem::path& path);

/// Writes a mesh as PLY (binary little-endian), OBJ, OFF, STL (binary) or GLB, told by the extension. The
/// file appears under its name only when it is complete (written beside it and renamed).
/// Errors: UnsupportedInput (unknown extension), IoError, and for GLB EmptyMesh.
[[nodiscard]] Result<void> write_mesh(const std::filesystem::path& path, const IndexedMesh& mesh);

}  // namespace vsplit::precompute
