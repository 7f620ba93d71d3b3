#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"
#include "surface_arrays.h"

#include <filesystem>

namespace vsplit::client {

/// Writes a mesh as binary little-endian PLY with double coordinates, so that every point of the
/// quantisation grid is kept exactly. The file appears complete or not at all.
/// `values`: one element a vertex of the mesh; its colours, texture coordinates of set 0 (as s and t, t
/// upwards) and normals of the author are written where it has them. Error: IoError.
[[nodiscard]] Result<void> write_ply(
    const std::filesystem::path& path, const IndexedMesh& mesh, const SurfaceArrays& values = {}
);

/// True when write_ply() has something to write of them.
[[nodiscard]] bool has_ply_values(const SurfaceArrays& values);

}  // namespace vsplit::client
