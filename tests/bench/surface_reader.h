#pragma once

#include "core/result.h"
#include "mesh/surface.h"

#include <filesystem>

namespace vsplit::bench {

/// Reads what the models that scripts/bench measures have: OBJ with triangles `v/vt/vn`, binary
/// little-endian PLY with normals and 8-bit colours by vertex. Nothing is repaired. For files of our own
/// choosing only: it believes what they say.
/// Errors: NotFound, IoError, NotAMesh.
[[nodiscard]] Result<Surface> read_bench_surface(const std::filesystem::path& path);

/// Repairs the mesh of a surface as the encoder does and lets the attributes follow.
/// Errors: those of repair_mesh(); Internal when a triangle cannot be found again.
/// Cost: that of repair_mesh().
[[nodiscard]] Result<Surface> repair_surface(const Surface& source);

}  // namespace vsplit::bench
