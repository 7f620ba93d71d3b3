#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "image/texture_layout.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::image {

/// Side of a precinct, as a power of two: small enough that a packet of usual images fits a chunk.
[[nodiscard]] unsigned precinct_side_log(const TextureHeader& header);

/// A packet that says that it brings nothing; a place that has got it gets nothing later either.
inline constexpr std::byte kNoPacket{0x00};

/// What the encoder writes for a precinct of which nothing was coded yet: no code block is included.
inline constexpr std::byte kUntouchedPacket{0x80};

/// Returns the main header of a JPEG 2000 code stream, SOC to QCD.
/// `header`: of the whole image; `dropped`: finest resolutions that are left out, the image being as
/// much smaller; `layers`: quality layers that follow.
/// Preconditions: members in their ranges, `dropped` <= levels, `layers` >= 1.
/// Source: ISO/IEC 15444-1, annexes A and E.
[[nodiscard]] std::vector<std::byte> main_header(
    const TextureHeader& header, unsigned dropped, unsigned layers
);

/// Appends the packets as the only tile and the end of the code stream.
void append_tile(std::vector<std::byte>& stream, std::span<const std::byte> packets);

/// An image as OpenJPEG coded it, taken apart.
struct CodedPackets
{
    std::vector<std::byte> bytes;        ///< Packets, one after the other.
    std::vector<std::uint32_t> lengths;  ///< Bytes of each.
};

/// Takes a code stream of ours apart.
/// `stream`: one tile with packet lengths (PLT). Errors: Internal when its main header, comments
/// aside, is not main_header() or it has another structure.
[[nodiscard]] Result<CodedPackets> split_code_stream(
    std::span<const std::byte> stream, const TextureHeader& header
);

}  // namespace vsplit::image
