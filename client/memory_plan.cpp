#include "memory_plan.h"

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

Result<MemoryPlan> plan_memory(
    const codec::StreamInfo& info, std::uint32_t wanted_level, const MemoryUse& use
)
{
    const auto finest = static_cast<std::uint32_t>(info.levels.size() - 1);
    const std::uint32_t wanted = std::min(wanted_level, finest);
    std::uint64_t needed = 0;
    for (std::uint32_t level = wanted + 1; level-- > 0;)
    {
        needed = needed_bytes(codec::prefix_info(info, level), use);
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
