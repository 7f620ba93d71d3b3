#include "codec/base_mesh_decoder.h"
#include "codec/entropy_coder.h"
#include "codec/small_base_coder.h"

#include <utility>

namespace vsplit::codec {

Result<GridMesh> decode_small_base(
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    const std::array<std::int32_t, 3>& extent
)
{
    if (vertices > kMaxSmallBaseVertices || faces > kMaxSmallBaseFaces * vertices)
    {
        return fail(ErrorCode::BadChunk, "the base mesh is too large for its codec");
    }
    BitDecoder bits;
    VSPLIT_TRY(bits.start(bytes));
    SmallBaseCoder<BitDecoder> coder(bits, vertices, faces, extent);
    if (!coder.run())
    {
        return fail(ErrorCode::BadChunk, "the base mesh does not decode");
    }
    VSPLIT_TRY(bits.finish());
    return std::move(coder.mesh());
}

Result<GridMesh> decode_base_chunk(const StreamInfo& info, std::span<const std::byte> bytes)
{
    const ChunkInfo& chunk = info.chunks.front();
    if (chunk.codec == proto::kDracoBaseCodec)
    {
        const auto max_index = static_cast<std::uint32_t>(info.grid.max_index() >> chunk.shift);
        return decode_draco_base(bytes, chunk.vertices, chunk.faces, max_index);
    }
    const auto [x, y, z] = info.extent;
    const std::array extent{x >> chunk.shift, y >> chunk.shift, z >> chunk.shift};
    return decode_small_base(bytes, chunk.vertices, chunk.faces, extent);
}

}  // namespace vsplit::codec
