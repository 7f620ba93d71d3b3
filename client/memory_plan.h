#pragma once

#include "codec/stream_info.h"
#include "core/result.h"

#include <cstdint>

namespace vsplit::client {

/// What a device with little memory will show of a stream.
struct MemoryPlan
{
    std::uint32_t level = 0;         ///< The finest level that fits.
    std::uint64_t needed_bytes = 0;  ///< Memory that decoder, arrays and GPU copies then take.
};

/// What the memory is needed for.
struct MemoryUse
{
    std::uint64_t cap_bytes = 0;    ///< Memory that the device has for the model.
    std::uint64_t queue_bytes = 0;  ///< Received bytes that wait.
    bool wireframe = false;         ///< Lines are drawn too.
};

/// Finds the finest level, not beyond `wanted_level`, whose memory fits the device.
/// `info`: header and index of the stream. Error: LimitExceeded when not even the base mesh fits.
/// Cost: levels times chunks. Thread safe.
[[nodiscard]] Result<MemoryPlan> plan_memory(
    const codec::StreamInfo& info, std::uint32_t wanted_level, const MemoryUse& use
);

}  // namespace vsplit::client
