#include "codec/error_scale.h"
#include "codec/stream_info.h"
#include "core/byte_reader.h"
#include "core/crc32c.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace vsplit::codec {
namespace {

constexpr std::size_t kChecksumOffset = 12;

std::uint32_t header_checksum(std::span<const std::byte> header)
{
    const std::uint32_t start = crc32c(header.first(kChecksumOffset));
    return crc32c(header.subspan(proto::kFixedHeaderBytes), start);
}

/// Reads a varint that must lie in low .. high.
Result<std::uint32_t> read_bounded(
    ByteReader& reader, std::uint64_t low, std::uint64_t high, const char* field
)
{
    const auto value = reader.read_varint();
    if (!value)
    {
        return tl::unexpected<Error>(value.error());
    }
    if (*value < low || *value > high)
    {
        return fail(
            ErrorCode::BadHeader,
            std::string("the header's ") + field + " is out of range",
            proto::kFixedHeaderBytes + reader.position()
        );
    }
    return static_cast<std::uint32_t>(*value);
}

/// Reads one number of the grid, stored in the header's choice of precision.
Result<double> read_number(ByteReader& reader, bool single)
{
    if (!single)
    {
        return reader.read_f64();
    }
    return reader.read<std::uint32_t>().map([](std::uint32_t bits) {
        return static_cast<double>(std::bit_cast<float>(bits));
    });
}

Result<void> read_grid(ByteReader& reader, StreamInfo& info)
{
    const auto bits = reader.read<std::uint8_t>();
    const int count = bits ? *bits & ~proto::kSinglePrecisionGrid : 0;
    if (count < proto::kMinPositionBits || count > proto::kMaxPositionBits)
    {
        return fail(ErrorCode::BadHeader, "the number of position bits is out of range", 16);
    }
    info.grid.bits = count;
    const bool single = (*bits & proto::kSinglePrecisionGrid) != 0;
    for (double& coordinate : info.grid.origin)
    {
        const auto value = read_number(reader, single);
        if (!value || !std::isfinite(*value))
        {
            return fail(ErrorCode::BadHeader, "the grid's origin is not finite", 17);
        }
        coordinate = *value;
    }
    const auto cell = read_number(reader, single);
    if (!cell || !std::isfinite(*cell) || !(*cell > 0.0))
    {
        return fail(ErrorCode::BadHeader, "the grid's cell is not a positive number", 29);
    }
    info.grid.cell = *cell;
    std::array<std::int32_t, 3> extent{};
    for (std::int32_t& index : extent)
    {
        const auto value = read_bounded(
            reader, 0, static_cast<std::uint64_t>(info.grid.max_index()), "bounding box"
        );
        VSPLIT_TRY(value);
        index = static_cast<std::int32_t>(*value);
    }
    info.box_min = dequantize(info.grid, {0, 0, 0});
    info.box_max = dequantize(info.grid, extent);
    return {};
}

/// Passes over the attribute table, which version 0 leaves empty: each entry is one length-prefixed
/// block, so that a reader of today accepts a file that carries more tomorrow.
Result<void> skip_attributes(ByteReader& reader)
{
    const auto count = read_bounded(reader, 0, 255, "attribute count");
    VSPLIT_TRY(count);
    for (std::uint32_t i = 0; i < *count; ++i)
    {
        const auto bytes = read_bounded(reader, 0, reader.remaining(), "attribute length");
        VSPLIT_TRY(bytes);
        VSPLIT_TRY(reader.read_bytes(*bytes));
    }
    return {};
}

/// State that one row of the index hands to the next.
struct RowContext
{
    proto::ChunkKind kind = proto::ChunkKind::Base;
    std::uint8_t codec = 0;
    std::uint32_t rms_code = 0;
    std::uint32_t max_code = 0;
    std::uint32_t vertices = 0;
    std::uint32_t faces = 0;
    std::uint64_t offset = 0;
    bool ends_level = true;
};

Result<void> read_error_code(ByteReader& reader, std::uint32_t& code)
{
    const auto zigzag = read_bounded(reader, 0, 2 * kZeroErrorCode, "error");
    VSPLIT_TRY(zigzag);
    const auto difference =
        static_cast<std::int32_t>(*zigzag >> 1) ^ -static_cast<std::int32_t>(*zigzag & 1U);
    const std::int32_t value = static_cast<std::int32_t>(code) + difference;
    if (value < 0 || value > static_cast<std::int32_t>(kZeroErrorCode))
    {
        return fail(ErrorCode::BadHeader, "an error in the index is out of range");
    }
    code = static_cast<std::uint32_t>(value);
    return {};
}

Result<void> read_counts(
    ByteReader& reader, RowContext& context, const StreamInfo& info, bool has_boundary
)
{
    if (context.kind == proto::ChunkKind::Base)
    {
        const auto vertices = read_bounded(reader, 3, info.vertex_count, "base vertex count");
        VSPLIT_TRY(vertices);
        const auto faces = read_bounded(reader, 1, info.face_count, "base face count");
        VSPLIT_TRY(faces);
        context.vertices = *vertices;
        context.faces = *faces;
        return {};
    }
    const auto splits =
        read_bounded(reader, 0, info.vertex_count - context.vertices, "split count");
    VSPLIT_TRY(splits);
    std::uint32_t boundary = 0;
    if (has_boundary)
    {
        const auto count = read_bounded(reader, 0, *splits, "boundary split count");
        VSPLIT_TRY(count);
        boundary = *count;
    }
    const std::uint64_t faces = std::uint64_t{context.faces} + 2ULL * *splits - boundary;
    if (faces > info.face_count)
    {
        return fail(ErrorCode::BadHeader, "the index adds up to more faces than the header says");
    }
    context.vertices += *splits;
    context.faces = static_cast<std::uint32_t>(faces);
    return {};
}

Result<void> check_kind(const RowContext& context, std::size_t row)
{
    const auto kind = static_cast<std::uint8_t>(context.kind);
    const bool known =
        context.kind == proto::ChunkKind::Base || context.kind == proto::ChunkKind::Batch;
    if (kind < proto::kFirstOptionalChunkKind && (!known || context.codec != 0))
    {
        return fail(
            ErrorCode::UnknownRequiredChunk,
            "the stream needs chunk kind " + std::to_string(kind) + " codec " +
                std::to_string(context.codec) + ", which this version does not know"
        );
    }
    if ((context.kind == proto::ChunkKind::Base) != (row == 0))
    {
        return fail(ErrorCode::BadHeader, "the base mesh must be the first chunk and only there");
    }
    return {};
}

Result<ChunkInfo> read_row(
    ByteReader& reader, RowContext& context, const StreamInfo& info, const DecodeLimits& limits
)
{
    ChunkInfo chunk{.kind = context.kind, .codec = context.codec};
    const auto length = reader.read_varint();
    VSPLIT_TRY(length);
    if (*length / 4 > limits.max_chunk_bytes)
    {
        return fail(ErrorCode::LimitExceeded, "a chunk is longer than the limit allows");
    }
    chunk.bytes = static_cast<std::uint32_t>(*length / 4);
    const bool has_boundary = (*length & proto::kRowHasBoundary) != 0;
    if (static_cast<std::uint8_t>(context.kind) < proto::kFirstOptionalChunkKind)
    {
        context.ends_level = (*length & proto::kRowContinuesLevel) == 0;
        VSPLIT_TRY(read_counts(reader, context, info, has_boundary));
        if (context.ends_level)
        {
            VSPLIT_TRY(read_error_code(reader, context.rms_code));
            VSPLIT_TRY(read_error_code(reader, context.max_code));
        }
    }
    // An optional chunk leaves a level as open or complete as it was.
    chunk.ends_level = context.ends_level;
    chunk.offset = context.offset;
    context.offset += chunk.bytes;
    chunk.vertices = context.vertices;
    chunk.faces = context.faces;
    chunk.rms_error = error_from_code(context.rms_code) * info.diagonal();
    chunk.max_error = error_from_code(context.max_code) * info.diagonal();
    return chunk;
}

Result<void> read_index(ByteReader& reader, StreamInfo& info, const DecodeLimits& limits)
{
    // A row takes at least one byte, which bounds the table by the bytes that are there.
    const auto count = read_bounded(
        reader, 1, std::min<std::uint64_t>(proto::kMaxChunks, reader.remaining()), "chunk count"
    );
    VSPLIT_TRY(count);
    info.chunks.reserve(*count);
    RowContext context{.offset = info.header_bytes};
    while (info.chunks.size() < *count)
    {
        const auto run = read_bounded(reader, 1, *count - info.chunks.size(), "run of chunks");
        VSPLIT_TRY(run);
        const auto kind = reader.read<std::uint8_t>();
        VSPLIT_TRY(kind);
        const auto codec = reader.read<std::uint8_t>();
        VSPLIT_TRY(codec);
        context.kind = static_cast<proto::ChunkKind>(*kind);
        context.codec = *codec;
        for (std::uint32_t i = 0; i < *run; ++i)
        {
            VSPLIT_TRY(check_kind(context, info.chunks.size()));
            auto chunk = read_row(reader, context, info, limits);
            VSPLIT_TRY(chunk);
            info.chunks.push_back(*chunk);
        }
    }
    info.file_bytes = context.offset;
    if (context.vertices != info.vertex_count || context.faces != info.face_count)
    {
        return fail(ErrorCode::BadHeader, "the index does not add up to the header's counts");
    }
    return {};
}

Result<void> collect_levels(StreamInfo& info)
{
    LevelInfo level;
    bool open = false;
    for (const ChunkInfo& chunk : info.chunks)
    {
        level.chunk_bytes += chunk.bytes;
        if (static_cast<std::uint8_t>(chunk.kind) >= proto::kFirstOptionalChunkKind)
        {
            continue;
        }
        open = !chunk.ends_level;
        if (chunk.ends_level)
        {
            level.vertices = chunk.vertices;
            level.faces = chunk.faces;
            level.rms_error = chunk.rms_error;
            level.max_error = chunk.max_error;
            level.cumulative_bytes = chunk.offset + chunk.bytes;
            info.levels.push_back(level);
            level = LevelInfo{.level = level.level + 1};
        }
    }
    if (open || info.levels.empty())
    {
        return fail(ErrorCode::BadHeader, "the last level is never completed");
    }
    if (info.levels.size() > proto::kMaxLevels)
    {
        return fail(ErrorCode::BadHeader, "the index lists too many levels");
    }
    // Optional chunks behind the last level belong to it.
    info.levels.back().chunk_bytes += level.chunk_bytes;
    info.levels.back().cumulative_bytes = info.file_bytes;
    return {};
}

}  // namespace

Result<std::uint32_t> parse_header_bytes(
    std::span<const std::byte> prefix, const DecodeLimits& limits
)
{
    ByteReader reader(prefix);
    const auto magic = reader.read<std::uint32_t>();
    VSPLIT_TRY(magic);
    if (*magic != proto::kStreamMagic)
    {
        return fail(ErrorCode::BadMagic, "this is not a vsplit stream");
    }
    const auto major = reader.read<std::uint8_t>();
    const auto minor = reader.read<std::uint8_t>();
    const auto flags = reader.read<std::uint16_t>();
    const auto header_bytes = reader.read<std::uint32_t>();
    VSPLIT_TRY(header_bytes);
    if (*major > proto::kStreamMajor || (*major == 0 && *minor != proto::kStreamMinor))
    {
        return fail(
            ErrorCode::UnsupportedVersion,
            "the stream has version " + std::to_string(*major) + "." + std::to_string(*minor) +
                ", this program reads " + std::to_string(proto::kStreamMajor) + "." +
                std::to_string(proto::kStreamMinor)
        );
    }
    if (*flags != 0 || *header_bytes < proto::kFixedHeaderBytes)
    {
        return fail(ErrorCode::BadHeader, "the fixed header is malformed", 6);
    }
    if (*header_bytes > limits.max_header_bytes)
    {
        return fail(ErrorCode::LimitExceeded, "the header is longer than the limit allows", 8);
    }
    return *header_bytes;
}

Result<StreamInfo> parse_stream_info(std::span<const std::byte> prefix, const DecodeLimits& limits)
{
    const auto header_bytes = parse_header_bytes(prefix, limits);
    VSPLIT_TRY(header_bytes);
    if (prefix.size() < *header_bytes)
    {
        return fail(ErrorCode::Truncated, "the header is not complete", prefix.size());
    }
    const auto header = prefix.first(*header_bytes);
    ByteReader checksum(header.subspan(kChecksumOffset));
    if (*checksum.read<std::uint32_t>() != header_checksum(header))
    {
        return fail(ErrorCode::BadChecksum, "the header is damaged", kChecksumOffset);
    }
    StreamInfo info;
    info.major = static_cast<std::uint8_t>(prefix[4]);
    info.minor = static_cast<std::uint8_t>(prefix[5]);
    info.header_bytes = *header_bytes;
    ByteReader reader(header.subspan(proto::kFixedHeaderBytes), proto::kFixedHeaderBytes);
    VSPLIT_TRY(read_grid(reader, info));
    const auto vertices = read_bounded(reader, 3, proto::kMaxVertices, "vertex count");
    VSPLIT_TRY(vertices);
    const auto faces = read_bounded(reader, 1, proto::kMaxFaces, "face count");
    VSPLIT_TRY(faces);
    info.vertex_count = *vertices;
    info.face_count = *faces;
    if (*vertices > limits.max_vertices || *faces > limits.max_faces)
    {
        return fail(ErrorCode::LimitExceeded, "the mesh is larger than the limit allows");
    }
    const auto content_checksum = reader.read<std::uint32_t>();
    VSPLIT_TRY(content_checksum);
    info.content_checksum = *content_checksum;
    VSPLIT_TRY(skip_attributes(reader));
    VSPLIT_TRY(read_index(reader, info, limits));
    if (reader.remaining() != 0)
    {
        return fail(ErrorCode::BadHeader, "bytes follow the index", reader.position());
    }
    VSPLIT_TRY(collect_levels(info));
    if (decoder_heap_bytes(prefix_info(info, limits.max_level)) > limits.max_heap_bytes)
    {
        return fail(ErrorCode::LimitExceeded, "decoding would need more memory than allowed");
    }
    return info;
}

}  // namespace vsplit::codec
