#pragma once

#include "codec/stream_info.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit::codec {

/// Decodes a base chunk of codec kDracoBaseCodec.
/// `bytes`: the Draco stream, to its end; `vertices`, `faces`: the counts that the index promises;
/// `max_index`: the largest coordinate on the base's grid. The stream's own counts, its attributes and
/// its entropy coder's tables are compared with what they may be before Draco takes memory for them.
/// Result: positions, which may still lie outside the grid, and triangles in Draco's order.
/// Error: BadChunk. Safe on untrusted input as far as Draco is; checksums are verified before.
[[nodiscard]] Result<GridMesh> decode_draco_base(
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    std::uint32_t max_index
);

/// Decodes a base chunk of codec kSmallBaseCodec.
/// `bytes`: its contents; `vertices`, `faces`: the counts that the index promises; `extent`: the largest
/// coordinate per axis on the base's grid. Result: positions, which may still lie outside the grid, and
/// triangles in the order in which they are coded. Error: BadChunk. Safe on untrusted input.
[[nodiscard]] Result<GridMesh> decode_small_base(
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    const std::array<std::int32_t, 3>& extent
);

/// Decodes a Parts chunk of codec 0.
/// `info`: of the stream; `bytes`: the chunk's contents; `vertices`, `faces`: that it adds; `shift`: of the
/// level that it adds them to. Result and error as decode_small_base()'s. Safe on untrusted input.
[[nodiscard]] Result<GridMesh> decode_parts_chunk(
    const StreamInfo& info,
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    int shift
);

/// Decodes the base chunk of a stream with the codec that its row names.
/// `info`: of the stream; `bytes`: the chunk's contents. Result and error as above. Safe on untrusted
/// input.
[[nodiscard]] Result<GridMesh> decode_base_chunk(
    const StreamInfo& info, std::span<const std::byte> bytes
);

}  // namespace vsplit::codec
