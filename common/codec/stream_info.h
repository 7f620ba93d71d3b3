#pragma once

#include "codec/level_attributes.h"
#include "core/result.h"
#include "format.h"
#include "mesh/quantization_grid.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vsplit::codec {

/// True for chunks that a reader may skip.
[[nodiscard]] constexpr bool is_optional(proto::ChunkKind kind)
{
    return static_cast<std::uint8_t>(kind) >= proto::kFirstOptionalChunkKind;
}

/// Bounds that a reader sets before it trusts a stream.
struct DecodeLimits
{
    std::uint32_t max_vertices = proto::kMaxVertices;
    std::uint32_t max_faces = proto::kMaxFaces;
    std::uint32_t max_header_bytes = proto::kMaxHeaderBytes;
    std::uint32_t max_chunk_bytes = 1U << 28;
    /// Largest heap that the decoder may come to use, bytes (see decoder_heap_bytes()).
    std::uint64_t max_heap_bytes = std::numeric_limits<std::uint64_t>::max();
    /// Finest level to decode: later ones are refused and no memory is kept for them.
    std::uint32_t max_level = std::numeric_limits<std::uint32_t>::max();
    bool attributes = true;  ///< False: chunks of attributes are skipped.
};

/// One row of the index: a run of bytes that is decoded as a whole.
struct ChunkInfo
{
    proto::ChunkKind kind = proto::ChunkKind::Batch;
    std::uint8_t codec = 0;      ///< Codec of this kind; 0 is the only one of version 0.
    bool ends_level = true;      ///< True when the mesh is at a level after it.
    std::uint64_t offset = 0;    ///< First byte in the file.
    std::uint32_t bytes = 0;     ///< Length, the checksum at its end included.
    std::uint32_t vertices = 0;  ///< Vertices of the mesh after it.
    std::uint32_t faces = 0;     ///< Triangles of the mesh after it.
    int shift = 0;               ///< Bits of precision that positions lack after it.
    double rms_error = 0.0;      ///< RMS surface distance to the source after it, model units.
    double max_error = 0.0;      ///< Largest sampled surface distance after it, model units.
    /// Of optional kinds: tells a reader what the chunk is about before it is fetched, by kind; see
    /// image::texture_tag() and picture_quality(). 0 for others.
    std::uint32_t tag = 0;
};

/// How near pictures of the model are to those of the original when a chunk and all before it have come:
/// peak signal-to-noise ratio, decibels, in steps of a quarter; 0 where that was not measured.
/// `tag`: of a chunk of attributes or of an image.
[[nodiscard]] constexpr double picture_quality(std::uint32_t tag)
{
    return 0.25 * static_cast<double>((tag >> 4U) & 255U);
}

/// Puts the quality of pictures into a tag. `squared_error`: mean over the pictures, 0 .. 65025.
[[nodiscard]] std::uint32_t with_picture_quality(std::uint32_t tag, double squared_error);

/// The mesh after a number of batches: level 0 is the base mesh.
struct LevelInfo
{
    std::uint32_t level = 0;
    std::uint32_t vertices = 0;
    std::uint32_t faces = 0;
    /// Bytes of its chunks, attributes included; level 0 without the header.
    std::uint64_t chunk_bytes = 0;
    std::uint64_t attribute_bytes = 0;  ///< Of these, chunks of attributes.
    std::uint64_t other_bytes =
        0;  ///< Chunks of materials and images between it and the next level.
    /// Length of the file prefix that shows this level with its attributes.
    std::uint64_t cumulative_bytes = 0;
    double rms_error = 0.0;        ///< Model units.
    double max_error = 0.0;        ///< Model units.
    double picture_quality = 0.0;  ///< Of the last chunk that tells it; see picture_quality().
};

/// Everything the header and the index say, known before any mesh data arrives.
struct StreamInfo
{
    std::uint8_t major = 0;
    std::uint8_t minor = 0;
    QuantizationGrid grid;
    std::array<std::int32_t, 3> extent{};  ///< Largest grid index per axis; the smallest is 0.
    std::array<double, 3> box_min{};       ///< Bounding box of the quantised mesh, model units.
    std::array<double, 3> box_max{};
    std::uint32_t vertex_count = 0;  ///< Vertices of the last level.
    std::uint32_t face_count = 0;    ///< Triangles of the last level.
    std::uint32_t header_bytes = 0;  ///< Length of header and index.
    std::uint64_t file_bytes = 0;    ///< Length of the whole stream.
    /// CRC-32C of the chunks' checksums (of the chunks themselves it would be a constant): makes
    /// headers of different contents differ, so that a transfer is never resumed with another file's
    /// bytes.
    std::uint32_t content_checksum = 0;
    std::vector<ChunkInfo> chunks;          ///< In file order.
    std::vector<LevelInfo> levels;          ///< Level 0 first.
    std::vector<AttributeInfo> attributes;  ///< Empty when the stream has none.
    std::uint32_t wedge_count = 0;  ///< Most wedges of the last level; 0 without attributes.

    /// Length of the bounding-box diagonal, model units.
    [[nodiscard]] double diagonal() const;
};

/// What a stream says of the size of its complete mesh.
struct WedgeCounts
{
    std::uint32_t wedges = 0;
    std::uint32_t vertices = 0;
};

/// Most wedges of a level that has `vertices` vertices, since every vertex to come has one at least.
[[nodiscard]] inline std::uint32_t most_wedges(const WedgeCounts& counts, std::uint32_t vertices)
{
    const std::uint32_t others = counts.vertices - std::min(vertices, counts.vertices);
    return counts.wedges - std::min(others, counts.wedges);
}

/// When to stop reading; unset members do not matter, the first one met stops.
struct StopCondition
{
    std::uint32_t level = std::numeric_limits<std::uint32_t>::max();  ///< Stop at this level.
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();  ///< Prefix at most so long.
    std::uint32_t faces = std::numeric_limits<std::uint32_t>::max();  ///< At most so many faces.
    /// Stop at the first level whose RMS error, model units, is not above this; negative never stops
    /// (flat models have coarse levels without any error).
    double error = -1.0;
};

/// Returns how many bytes of a stream must be there before its header length is known.
[[nodiscard]] constexpr std::size_t header_probe_bytes()
{
    return proto::kHeaderProbeBytes;
}

/// Reads the length of header and index from the first header_probe_bytes() bytes.
/// `prefix`: the first bytes of a stream. Errors: Truncated, BadMagic, UnsupportedVersion, BadHeader,
/// LimitExceeded. Safe on untrusted input.
[[nodiscard]] Result<std::uint32_t> parse_header_bytes(
    std::span<const std::byte> prefix, const DecodeLimits& limits = {}
);

/// Parses header and index.
/// `prefix`: at least the header's bytes of a stream; more does no harm.
/// Errors: those of parse_header_bytes, BadChecksum, UnknownRequiredChunk, LimitExceeded.
/// Cost: linear in the header. Thread safe. Safe on untrusted input.
/// Source: proto/STREAM_FORMAT.md, "Header" and "Index".
[[nodiscard]] Result<StreamInfo> parse_stream_info(
    std::span<const std::byte> prefix, const DecodeLimits& limits = {}
);

/// Checks a chunk against the CRC-32C at its end.
/// `bytes`: the whole chunk; `offset`: its place in the file, for the error.
/// Result: the chunk without its checksum. Errors: BadChecksum. Safe on untrusted input.
[[nodiscard]] Result<std::span<const std::byte>> chunk_contents(
    std::span<const std::byte> bytes, std::uint64_t offset
);

/// Returns the length of the file prefix to read for a stop condition: a chunk boundary, at least
/// header and base, at most the file. `bytes` below header and base still gives header and base.
[[nodiscard]] std::uint64_t stop_offset(const StreamInfo& info, const StopCondition& stop);

/// Returns what header and index would say of a stream that ends with `level`: chunks that belong to
/// later levels are left out. A level beyond the last gives `info` itself. Cost: linear in the index.
[[nodiscard]] StreamInfo prefix_info(const StreamInfo& info, std::uint32_t level);

/// Returns what header and index would say without chunks of attributes, as for a decoder that skips them.
[[nodiscard]] StreamInfo without_attributes(StreamInfo info);

/// What of a stream's chunks is the largest.
struct LargestChunk
{
    std::uint32_t bytes = 0;
    std::uint32_t splits = 0;
};

/// The longest chunk, and the most splits of one.
[[nodiscard]] LargestChunk largest_chunk(const StreamInfo& info);

/// Vertices and triangles of the finest mesh that splits lead to: the last one, or the coarse mesh over
/// which the complete one grows.
struct RefinedCounts
{
    std::uint32_t vertices = 0;
    std::uint32_t faces = 0;
};

/// Finds them. Cost: linear in the index.
[[nodiscard]] RefinedCounts refined_counts(const StreamInfo& info);

/// Returns an upper bound of the heap that a StreamDecoder needs for the whole stream, bytes; for a
/// decoder with DecodeLimits::max_level ask with prefix_info(), for one that skips attributes with
/// without_attributes().
[[nodiscard]] std::uint64_t decoder_heap_bytes(const StreamInfo& info);

}  // namespace vsplit::codec
