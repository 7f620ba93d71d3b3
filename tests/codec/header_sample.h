#pragma once

#include "codec/stream_header_writer.h"
#include "codec/stream_info.h"
#include "codec/stream_parts.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vsplit::test {

/// A header with two levels, the second one in two chunks, and stitches at the end.
[[nodiscard]] inline codec::StreamInfo sample_info()
{
    using proto::ChunkKind;
    codec::StreamInfo info;
    info.grid = {.origin = {-1.5, 0.25, 100.0}, .cell = 0.125, .bits = 10};
    info.content_checksum = 0x12345678;
    info.chunks = {
        {.kind = ChunkKind::Base, .bytes = 100, .vertices = 10, .faces = 16, .shift = 4},
        {.ends_level = false, .bytes = 50, .vertices = 20, .faces = 35},
        {.bytes = 70, .vertices = 30, .faces = 55, .rms_error = 0.5, .max_error = 2.0},
        {.kind = ChunkKind::Stitch, .bytes = 9, .vertices = 30, .faces = 55},
    };
    info.chunks[0].rms_error = 3.0;
    info.chunks[0].max_error = 7.0;
    info.vertex_count = 30;
    info.face_count = 55;
    return info;
}

/// Magic and version come first.
inline constexpr std::size_t kLengthOffset = 5;

/// Position bits and flags, the grid in single precision, the content checksum; then bit streams.
inline constexpr std::size_t kGridOffset = kLengthOffset + 1;
inline constexpr std::size_t kIndexOffset = kGridOffset + 1 + 16 + 4;

inline constexpr std::array<std::int32_t, 3> kExtent{1023, 500, 0};

/// Writes the header of a stream whose box is kExtent.
[[nodiscard]] inline Bytes write_header(const codec::StreamInfo& info)
{
    return codec::write_stream_header(info, kExtent);
}

/// What parsing a header comes to.
[[nodiscard]] inline ErrorCode code_of(const Bytes& header, const codec::DecodeLimits& limits = {})
{
    const auto info = codec::parse_stream_info(header, limits);
    return info ? ErrorCode::Ok : info.error().code;
}

}  // namespace vsplit::test
