#pragma once

#include "codec/stream_info.h"
#include "core/result.h"

#include <cstdint>

namespace vsplit::client {

/// What a device with little memory will show of a stream.
struct MemoryPlan
{
    std::uint32_t level = 0;  ///< The finest level that fits.
    /// Memory that decoder, arrays, GPU copies and textures then take.
    std::uint64_t needed_bytes = 0;
    std::uint32_t texture_limit =
        0;  ///< Longest side of a texture that fits, pixels; 0: no textures.
    std::uint64_t texture_bytes = 0;  ///< Part of needed_bytes that textures take.
};

/// What the memory is needed for.
struct MemoryUse
{
    std::uint64_t cap_bytes = 0;    ///< Memory that the device has for the model.
    std::uint64_t queue_bytes = 0;  ///< Received bytes that wait.
    bool wireframe = false;         ///< Lines are drawn too.
    bool surface = false;           ///< Levels are drawn with attributes.
    std::uint32_t texture_limit =
        0;  ///< Longest side of a texture that is wanted, pixels; 0: none.
};

/// Returns the memory that the textures of a stream take with a limit on their sides: decoded with
/// mipmaps, the coded images, and what decoding the largest takes, bytes. Sides are not in the index:
/// what the chunks' tags say is taken for both. Cost: linear in the index. Thread safe.
[[nodiscard]] std::uint64_t texture_memory_bytes(
    const codec::StreamInfo& info, std::uint32_t texture_limit
);

/// Finds the finest level, not beyond `wanted_level`, whose memory fits the device. Textures give way
/// first, halving their sides down to 256 pixels; only what is left without any level loses them.
/// `info`: header and index of the stream. Error: LimitExceeded when not even the base mesh fits.
/// Cost: levels times chunks. Thread safe.
[[nodiscard]] Result<MemoryPlan> plan_memory(
    const codec::StreamInfo& info, std::uint32_t wanted_level, const MemoryUse& use
);

}  // namespace vsplit::client
