#include "codec/base_mesh_decoder.h"
#include "codec/entropy_coder.h"
#include "codec/small_base_coder.h"

#include <utility>

namespace vsplit::codec {
namespace {

std::array<std::int32_t, 3> extent_at(const StreamInfo& info, int shift)
{
    return {info.extent[0] >> shift, info.extent[1] >> shift, info.extent[2] >> shift};
}

Result<GridMesh> decode_small(
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    const std::array<std::int32_t, 3>& extent,
    ComponentStart start
)
{
    if (vertices > kMaxSmallBaseVertices || faces > kMaxSmallBaseFaces * vertices)
    {
        return fail(ErrorCode::BadChunk, "the base mesh is too large for its codec");
    }
    BitDecoder bits;
    VSPLIT_TRY(bits.start(bytes));
    SmallBaseCoder<BitDecoder> coder(bits, vertices, faces, extent, start);
    if (!coder.run())
    {
        return fail(ErrorCode::BadChunk, "the base mesh does not decode");
    }
    VSPLIT_TRY(bits.finish());
    return std::move(coder.mesh());
}

}  // namespace

Result<GridMesh> decode_small_base(
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    const std::array<std::int32_t, 3>& extent
)
{
    return decode_small(bytes, vertices, faces, extent, ComponentStart::Centre);
}

Result<GridMesh> decode_parts_chunk(
    const StreamInfo& info,
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    int shift
)
{
    return decode_small(bytes, vertices, faces, extent_at(info, shift), ComponentStart::LastVertex);
}

Result<GridMesh> decode_base_chunk(const StreamInfo& info, std::span<const std::byte> bytes)
{
    const ChunkInfo& chunk = info.chunks.front();
    if (chunk.codec == proto::kDracoBaseCodec)
    {
        const auto max_index = static_cast<std::uint32_t>(info.grid.max_index() >> chunk.shift);
        return decode_draco_base(bytes, chunk.vertices, chunk.faces, max_index);
    }
    return decode_small_base(bytes, chunk.vertices, chunk.faces, extent_at(info, chunk.shift));
}

}  // namespace vsplit::codec
