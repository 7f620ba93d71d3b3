#include "codec/entropy_coder.h"
#include "codec/error_scale.h"
#include "codec/index_coder.h"
#include "codec/stream_info.h"
#include "core/byte_reader.h"
#include "core/crc32c.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace vsplit::codec {
namespace {

/// Magic and version, behind which the header's length stands.
constexpr std::size_t kLengthOffset = 5;

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
            reader.position()
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

/// Result: whether a table of attributes follows.
Result<bool> read_grid(ByteReader& reader, StreamInfo& info)
{
    const auto bits = reader.read<std::uint8_t>();
    const int count = bits ? *bits & ~(proto::kSinglePrecisionGrid | proto::kHasAttributes) : 0;
    if (count < proto::kMinPositionBits || count > proto::kMaxPositionBits)
    {
        return fail(ErrorCode::BadHeader, "the number of position bits is out of range");
    }
    info.grid.bits = count;
    const bool single = (*bits & proto::kSinglePrecisionGrid) != 0;
    for (double& coordinate : info.grid.origin)
    {
        const auto value = read_number(reader, single);
        if (!value || !std::isfinite(*value))
        {
            return fail(ErrorCode::BadHeader, "the grid's origin is not finite");
        }
        coordinate = *value;
    }
    const auto cell = read_number(reader, single);
    if (!cell || !std::isfinite(*cell) || !(*cell > 0.0))
    {
        return fail(ErrorCode::BadHeader, "the grid's cell is not a positive number");
    }
    info.grid.cell = *cell;
    return (*bits & proto::kHasAttributes) != 0;
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

Result<void> read_extent(BitDecoder& bits, StreamInfo& info)
{
    const std::uint32_t full = bits.raw(0, 2);
    for (std::uint32_t axis = 0; axis < 3; ++axis)
    {
        info.extent[axis] = axis == full ? info.grid.max_index()
                                         : static_cast<std::int32_t>(bits.raw(0, info.grid.bits));
    }
    info.box_min = dequantize(info.grid, {0, 0, 0});
    info.box_max = dequantize(info.grid, info.extent);
    return std::isfinite(info.diagonal())
               ? Result<void>{}
               : fail(ErrorCode::BadHeader, "the bounding box is not finite");
}

bool is_optional(proto::ChunkKind kind)
{
    return static_cast<std::uint8_t>(kind) >= proto::kFirstOptionalChunkKind;
}

/// Reads the rows of the index one after another into the table of chunks.
class IndexReader
{
public:
    IndexReader(BitDecoder& bits, StreamInfo& info, const DecodeLimits& limits)
        : bits_(bits), index_(bits), info_(info), limits_(limits), diagonal_(info.diagonal())
    {
    }

    Result<void> run()
    {
        const std::uint32_t count = index_.code_number(0);
        if (count < 1 || count > proto::kMaxChunks)
        {
            return fail(ErrorCode::BadHeader, "the header's chunk count is out of range");
        }
        info_.file_bytes = info_.header_bytes;
        // Rows can take less than a bit, so the table grows as rows are really there.
        while (info_.chunks.size() < count)
        {
            VSPLIT_TRY(read_row());
            if (bits_.exhausted())
            {
                return fail(ErrorCode::BadHeader, "the index ends too early");
            }
        }
        return index_.level_complete()
                   ? Result<void>{}
                   : fail(ErrorCode::BadHeader, "the last level is never completed");
    }

private:
    Result<void> read_row()
    {
        IndexRow row;
        const bool base = info_.chunks.empty();
        if (!base)
        {
            index_.code_kind(row);
        }
        VSPLIT_TRY(check_kind(row));
        const bool optional = is_optional(row.kind);
        if (optional)
        {
            index_.code_optional(row);
        }
        else if (base ? !index_.code_base(row) : !index_.code_batch(row))
        {
            return fail(ErrorCode::BadHeader, "a row of the index is out of range");
        }
        if (base && row.codec > proto::kSmallBaseCodec)
        {
            return unknown_chunk(row);
        }
        if (row.bytes > limits_.max_chunk_bytes)
        {
            return fail(ErrorCode::LimitExceeded, "a chunk is longer than the limit allows");
        }
        if (!optional)
        {
            VSPLIT_TRY(take(row));
        }
        add_chunk(row);
        return {};
    }

    static tl::unexpected<Error> unknown_chunk(const IndexRow& row)
    {
        return fail(
            ErrorCode::UnknownRequiredChunk,
            "the stream needs chunk kind " + std::to_string(static_cast<int>(row.kind)) +
                " codec " + std::to_string(row.codec) + ", which this version does not know"
        );
    }

    /// Checks the kind of any row but the base's.
    static Result<void> check_kind(const IndexRow& row)
    {
        if (is_optional(row.kind) || (row.kind == proto::ChunkKind::Batch && row.codec == 0))
        {
            return {};
        }
        if (row.kind == proto::ChunkKind::Base)
        {
            return fail(
                ErrorCode::BadHeader, "the base mesh must be the first chunk and only there"
            );
        }
        return unknown_chunk(row);
    }

    /// Adds up vertices and faces.
    Result<void> take(const IndexRow& row)
    {
        const bool base = info_.chunks.empty();
        if (base && row.shift >= info_.grid.bits)
        {
            return fail(ErrorCode::BadHeader, "the base mesh has no precision");
        }
        const std::uint64_t faces =
            base ? row.faces : last_.faces + 2ULL * row.vertices - row.boundary;
        last_.vertices += row.vertices;
        if (faces > proto::kMaxFaces)
        {
            return fail(ErrorCode::BadHeader, "the index adds up to too many faces");
        }
        if (last_.vertices > limits_.max_vertices || faces > limits_.max_faces)
        {
            return fail(ErrorCode::LimitExceeded, "the mesh is larger than the limit allows");
        }
        last_.faces = static_cast<std::uint32_t>(faces);
        last_.ends_level = index_.level_complete();
        if (base || row.level_chunks != 0)
        {
            last_.shift = row.shift;
        }
        if (last_.ends_level)
        {
            last_.rms_error = error_from_code(row.rms_code) * diagonal_;
            last_.max_error = error_from_code(row.max_code) * diagonal_;
        }
        return {};
    }

    void add_chunk(const IndexRow& row)
    {
        // An optional chunk leaves a level as open or complete as it was.
        ChunkInfo chunk = last_;
        chunk.kind = row.kind;
        chunk.codec = row.codec;
        chunk.bytes = row.bytes;
        chunk.offset = info_.file_bytes;
        info_.file_bytes += chunk.bytes;
        info_.vertex_count = chunk.vertices;
        info_.face_count = chunk.faces;
        info_.chunks.push_back(chunk);
    }

    BitDecoder& bits_;
    IndexCoder<BitDecoder> index_;
    StreamInfo& info_;
    const DecodeLimits& limits_;
    double diagonal_;
    ChunkInfo last_;  ///< The last required chunk.
};

Result<void> collect_levels(StreamInfo& info)
{
    LevelInfo level;
    for (const ChunkInfo& chunk : info.chunks)
    {
        level.chunk_bytes += chunk.bytes;
        if (static_cast<std::uint8_t>(chunk.kind) >= proto::kFirstOptionalChunkKind)
        {
            continue;
        }
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
    ByteReader reader(prefix.first(std::min(prefix.size(), proto::kHeaderProbeBytes)));
    const auto magic = reader.read<std::uint32_t>();
    VSPLIT_TRY(magic);
    if (*magic != proto::kStreamMagic)
    {
        return fail(ErrorCode::BadMagic, "this is not a vsplit stream");
    }
    const auto version = reader.read<std::uint8_t>();
    VSPLIT_TRY(version);
    const int major = *version >> 4;
    const int minor = *version & 15;
    if (major > proto::kStreamMajor || (major == 0 && minor != proto::kStreamMinor))
    {
        return fail(
            ErrorCode::UnsupportedVersion,
            "the stream has version " + std::to_string(major) + "." + std::to_string(minor) +
                ", this program reads " + std::to_string(proto::kStreamMajor) + "." +
                std::to_string(proto::kStreamMinor)
        );
    }
    const auto header_bytes = reader.read_varint();
    const bool endless = !header_bytes && reader.position() == proto::kHeaderProbeBytes;
    if (endless || (header_bytes && *header_bytes > limits.max_header_bytes))
    {
        return fail(ErrorCode::LimitExceeded, "the header is longer than the limit allows", 5);
    }
    VSPLIT_TRY(header_bytes);
    if (*header_bytes < proto::kHeaderProbeBytes)
    {
        return fail(ErrorCode::BadHeader, "the header is too short", 5);
    }
    return static_cast<std::uint32_t>(*header_bytes);
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
    if (crc32c(header) != kCrc32cResidue)
    {
        return fail(ErrorCode::BadChecksum, "the header is damaged");
    }
    StreamInfo info;
    info.major = static_cast<std::uint8_t>(prefix[4] >> 4);
    info.minor = static_cast<std::uint8_t>(prefix[4] & std::byte{15});
    info.header_bytes = *header_bytes;
    ByteReader reader(header.first(header.size() - proto::kChunkChecksumBytes));
    VSPLIT_TRY(reader.read_bytes(kLengthOffset));
    VSPLIT_TRY(reader.read_varint());
    const auto has_attributes = read_grid(reader, info);
    VSPLIT_TRY(has_attributes);
    const auto content_checksum = reader.read<std::uint32_t>();
    VSPLIT_TRY(content_checksum);
    info.content_checksum = *content_checksum;
    if (*has_attributes)
    {
        VSPLIT_TRY(skip_attributes(reader));
    }
    BitDecoder bits;
    if (!bits.start(*reader.read_bytes(reader.remaining())))
    {
        return fail(ErrorCode::BadHeader, "the header has no index", reader.position());
    }
    VSPLIT_TRY(read_extent(bits, info));
    VSPLIT_TRY(IndexReader(bits, info, limits).run());
    if (!bits.finish())
    {
        return fail(ErrorCode::BadHeader, "the index does not end where the header does");
    }
    VSPLIT_TRY(collect_levels(info));
    if (decoder_heap_bytes(prefix_info(info, limits.max_level)) > limits.max_heap_bytes)
    {
        return fail(ErrorCode::LimitExceeded, "decoding would need more memory than allowed");
    }
    return info;
}

}  // namespace vsplit::codec
