#include "memory_plan.h"

#include "gl_textures.h"
#include "gpu_buffers.h"
#include "image/texture_decoder.h"
#include "surface_arrays.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace vsplit::client {
namespace {

// Smaller textures save nothing: every image comes at this size at least.
constexpr std::uint32_t kLeastTextureLimit = 1U << image::kFirstGroupLog;

std::uint64_t geometry_bytes(const codec::StreamInfo& prefix, const MemoryUse& use)
{
    const std::uint64_t arrays =
        use.surface
            ? surface_memory_bytes(
                  prefix.vertex_count, prefix.face_count, prefix.attributes, use.wireframe
              )
            : GpuBuffers::memory_bytes(prefix.vertex_count, prefix.face_count, use.wireframe);
    return codec::decoder_heap_bytes(prefix) + use.queue_bytes + arrays;
}

// The limits to try, the largest first.
std::vector<std::uint32_t> texture_limits(std::uint32_t wanted)
{
    std::vector<std::uint32_t> limits{wanted};
    while (limits.back() / 2 >= kLeastTextureLimit)
    {
        limits.push_back(limits.back() / 2);
    }
    return limits;
}

}  // namespace

std::uint64_t texture_memory_bytes(const codec::StreamInfo& info, std::uint32_t texture_limit)
{
    std::map<std::uint32_t, std::uint32_t> sides;  // By image.
    std::uint64_t coded = 0;
    for (const codec::ChunkInfo& chunk : info.chunks)
    {
        if (chunk.kind != proto::ChunkKind::Texture || texture_limit == 0 ||
            !image::texture_chunk_wanted(chunk.tag, texture_limit))
        {
            continue;
        }
        const image::TextureTag tag = image::parse_texture_tag(chunk.tag);
        std::uint32_t& side = sides[tag.image];
        side = std::max(side, std::min(tag.side, texture_limit));
        coded += chunk.bytes;
    }
    std::uint64_t textures = 0;
    std::uint64_t decoding = 0;
    for (const auto& [number, side] : sides)
    {
        // While one is replaced there are two of it, and what is sent to the GPU.
        const std::uint64_t own = texture_bytes(side, side);
        const ImageInfo square{"", side, side, 4};
        textures += own;
        decoding = std::max(
            decoding,
            image::texture_decode_bytes(square, side) + own + std::uint64_t{4} * side * side
        );
    }
    return textures + coded + decoding;
}

Result<MemoryPlan> plan_memory(
    const codec::StreamInfo& info, std::uint32_t wanted_level, const MemoryUse& use
)
{
    const auto finest = static_cast<std::uint32_t>(info.levels.size() - 1);
    const std::uint32_t wanted = std::min(wanted_level, finest);
    std::uint64_t needed = 0;
    for (std::uint32_t level = wanted + 1; level-- > 0;)
    {
        const codec::StreamInfo prefix = codec::prefix_info(info, level);
        needed = geometry_bytes(prefix, use);
        std::vector<std::uint32_t> limits = texture_limits(use.texture_limit);
        if (level == 0)
        {
            limits.push_back(0);
        }
        for (const std::uint32_t limit : limits)
        {
            const std::uint64_t textures = texture_memory_bytes(prefix, limit);
            if (needed + textures <= use.cap_bytes)
            {
                return MemoryPlan{level, needed + textures, limit, textures};
            }
        }
    }
    return fail(
        ErrorCode::LimitExceeded,
        "the base mesh needs " + std::to_string(needed) + " bytes of memory, the device has " +
            std::to_string(use.cap_bytes)
    );
}

}  // namespace vsplit::client
