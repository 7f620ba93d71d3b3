#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit::codec {

/// Decodes the Draco mesh of a base chunk.
/// `bytes`: the Draco stream; `vertices`, `faces`: the counts that the index promises; the stream's own
/// counts are compared with them before Draco may allocate. Result: grid positions and triangles in
/// Draco's order. Error: BadChunk. Safe on untrusted input as far as Draco is; checksums are verified
/// before.
[[nodiscard]] Result<GridMesh> decode_base_mesh(
    std::span<const std::byte> bytes, std::uint32_t vertices, std::uint32_t faces
);

}  // namespace vsplit::codec
