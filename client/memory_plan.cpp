#include "memory_plan.h"

#include "core/assert.h"
#include "gpu_buffers.h"

#include <algorithm>
#include <string>

namespace vsplit::client {
namespace {

std::uint64_t needed_bytes(const codec::StreamInfo& prefix, const MemoryUse& use)
{
    return codec::decoder_heap_bytes(prefix) + use.queue_bytes +
           GpuBuffers::memory_bytes(prefix.vertex_count, prefix.face_count, use.wireframe);
}

}  // namespace

codec::StreamInfo prefix_info(const codec::StreamInfo& info, std::uint32_t level)
{
    VSPLIT_ASSERT(level < info.levels.size());
    codec::StreamInfo prefix = info;
    prefix.levels.resize(std::size_t{level} + 1);
    const codec::LevelInfo& last = prefix.levels.back();
    prefix.vertex_count = last.vertices;
    prefix.face_count = last.faces;
    prefix.file_bytes = last.cumulative_bytes;
    std::erase_if(prefix.chunks, [&](const codec::ChunkInfo& chunk) {
        return chunk.offset >= last.cumulative_bytes;
    });
    return prefix;
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
        // The last level may be followed by chunks that change no triangle; it counts them too.
        needed = needed_bytes(level == finest ? info : prefix_info(info, level), use);
        if (needed <= use.cap_bytes)
        {
            return MemoryPlan{level, needed};
        }
    }
    return fail(
        ErrorCode::LimitExceeded,
        "the base mesh needs " + std::to_string(needed) + " bytes of memory, the device has " +
            std::to_string(use.cap_bytes)
    );
}

}  // namespace vsplit::client
