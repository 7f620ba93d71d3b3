#pragma once

#include "codec/stream_info.h"
#include "core/result.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace vsplit::codec {

/// A chunk to be put into a stream, without its checksum.
struct ExtraChunk
{
    std::size_t after = 0;  ///< Index of the stream's chunk that it follows.
    proto::ChunkKind kind = proto::ChunkKind::Attributes;
    std::uint8_t codec = 0;
    std::uint32_t tag = 0;  ///< See ChunkInfo.
    std::vector<std::byte> bytes;
};

/// Writes header and index.
/// `info`: grid, counts, attributes, content checksum, and for each chunk kind, codec, tag, bytes, ends_level, vertices, faces and errors; its other members are ignored. `extent`: largest grid index of the mesh per axis (the
/// smallest is 0). Result: the bytes that parse_stream_info() reads; errors come back rounded up to
/// the next 1/32 octave. Source: proto/STREAM_FORMAT.md, "Header" and "Index".
[[nodiscard]] std::vector<std::byte> write_stream_header(
    const StreamInfo& info, const std::array<std::int32_t, 3>& extent
);

/// What the index says of a level.
struct LevelErrors
{
    double rms = 0.0;  ///< Model units.
    double max = 0.0;  ///< Model units.
};

/// Writes the header of a finished stream anew with other errors: they can then be measured while the
/// stream is coded. `errors`: one entry a level. Result: the bytes that encode_stream() would have made.
/// Errors: those of parse_stream_info(); Internal when the number of levels is another.
[[nodiscard]] Result<std::vector<std::byte>> replace_errors(
    std::span<const std::byte> file, std::span<const LevelErrors> errors
);

/// Puts optional chunks into a finished stream. `extra`: in the order of `after`; `tags`: by chunk of the stream
/// its new tag, or empty: as they are.
/// Errors: those of parse_stream_info(); Internal when a chunk would follow none of the stream.
[[nodiscard]] Result<std::vector<std::byte>> insert_chunks(
    std::span<const std::byte> file,
    std::span<const ExtraChunk> extra,
    std::span<const std::uint32_t> tags = {}
);

}  // namespace vsplit::codec
