#include "codec/entropy_coder.h"
#include "codec/error_scale.h"
#include "codec/index_coder.h"
#include "codec/index_reader.h"
#include "codec/stream_info.h"
#include "core/byte_reader.h"
#include "core/crc32c.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

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

/// Reads one attribute; `reader` holds its entry and nothing else.
Result<AttributeInfo> read_attribute(ByteReader reader)
{
    const auto shape = reader.read<std::uint8_t>();
    VSPLIT_TRY(shape);
    const auto set = reader.read<std::uint8_t>();
    VSPLIT_TRY(set);
    const auto bits = reader.read<std::uint8_t>();
    VSPLIT_TRY(bits);
    AttributeInfo info;
    info.kind = static_cast<AttributeKind>(*shape & 7);
    info.rgb = (*shape & proto::kRgbColor) != 0;
    info.components = *shape >> 4;
    info.set = *set;
    info.bits = *bits;
    if (!is_valid(info))
    {
        return fail(ErrorCode::BadHeader, "the header describes an attribute that cannot be");
    }
    if (has_grid(info))
    {
        for (std::size_t k = 0; k < info.components; ++k)
        {
            const auto origin = read_number(reader, true);
            VSPLIT_TRY(origin);
            info.origin[k] = static_cast<float>(*origin);
        }
        const auto cell = read_number(reader, true);
        VSPLIT_TRY(cell);
        info.cell = static_cast<float>(*cell);
        const bool finite =
            std::ranges::all_of(info.origin, [](float x) { return std::isfinite(x); });
        if (!finite || !std::isfinite(info.cell) || !(info.cell > 0.0F))
        {
            return fail(ErrorCode::BadHeader, "the grid of an attribute is not finite");
        }
    }
    else
    {
        info.cell = 1.0F / static_cast<float>((1 << info.bits) - 1);
    }
    const auto name = *reader.read_bytes(reader.remaining());
    std::ranges::transform(name, std::back_inserter(info.name), [](std::byte b) {
        return static_cast<char>(b);
    });
    return info;
}

Result<void> read_attributes(ByteReader& reader, StreamInfo& info)
{
    const auto wedges = read_bounded(reader, 0, 3ULL * proto::kMaxFaces, "wedge count");
    VSPLIT_TRY(wedges);
    info.wedge_count = *wedges;
    const auto count = read_bounded(reader, 0, proto::kMaxAttributes, "attribute count");
    VSPLIT_TRY(count);
    for (std::uint32_t i = 0; i < *count; ++i)
    {
        const auto bytes = read_bounded(reader, 0, reader.remaining(), "attribute length");
        VSPLIT_TRY(bytes);
        const auto attribute = read_attribute(ByteReader(*reader.read_bytes(*bytes)));
        if (!attribute)
        {
            return fail(
                ErrorCode::BadHeader,
                "the header's table of attributes is damaged",
                reader.position()
            );
        }
        info.attributes.push_back(*attribute);
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

/// Counts an optional chunk with a level.
void count_optional(const ChunkInfo& chunk, LevelInfo& level)
{
    const bool tells =
        chunk.kind == proto::ChunkKind::Attributes || chunk.kind == proto::ChunkKind::Texture;
    if (tells && picture_quality(chunk.tag) > 0.0)
    {
        level.picture_quality = picture_quality(chunk.tag);
    }
    if (chunk.kind == proto::ChunkKind::Appearance || chunk.kind == proto::ChunkKind::Texture)
    {
        level.other_bytes += chunk.bytes;
        return;
    }
    level.chunk_bytes += chunk.bytes;
    level.attribute_bytes += chunk.kind == proto::ChunkKind::Attributes ? chunk.bytes : 0;
    level.cumulative_bytes = chunk.offset + chunk.bytes;
}

Result<void> collect_levels(StreamInfo& info)
{
    LevelInfo level;
    for (const ChunkInfo& chunk : info.chunks)
    {
        if (is_optional(chunk.kind))
        {
            // What stands within a level is of no use before it ends, and counts with it.
            count_optional(chunk, chunk.ends_level ? info.levels.back() : level);
            continue;
        }
        level.chunk_bytes += chunk.bytes;
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
        VSPLIT_TRY(read_attributes(reader, info));
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
    if (*has_attributes &&
        (info.wedge_count < info.vertex_count || info.wedge_count > 3ULL * info.face_count))
    {
        return fail(ErrorCode::BadHeader, "the header's wedge count does not fit the mesh");
    }
    StreamInfo used = prefix_info(info, limits.max_level);
    used = limits.attributes ? std::move(used) : without_attributes(std::move(used));
    if (decoder_heap_bytes(used) > limits.max_heap_bytes)
    {
        return fail(ErrorCode::LimitExceeded, "decoding would need more memory than allowed");
    }
    return info;
}

}  // namespace vsplit::codec
