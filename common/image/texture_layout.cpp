// Based on: Taubman and Marcellin, JPEG2000: Image Compression Fundamentals, Standards and Practice,
// 2002; ISO/IEC 15444-1. Names below are the standard's.
#include "image/texture_layout.h"

#include "image/code_stream.h"

#include <algorithm>
#include <bit>

namespace vsplit::image {

namespace {

constexpr unsigned kReversibleFlag = 4;
constexpr unsigned kColorTransformFlag = 8;

constexpr std::uint32_t shifted_up(std::uint32_t length, unsigned shift)
{
    return (length + (1U << shift) - 1U) >> shift;
}

unsigned group_of_side(std::uint32_t side)
{
    const auto log = static_cast<unsigned>(std::bit_width(side - 1U));
    return log <= kFirstGroupLog ? 0U : log - kFirstGroupLog;
}

}  // namespace

void write_texture_header(const TextureHeader& header, ByteWriter& writer)
{
    const unsigned flags = (header.channels - 1U) | (header.reversible ? kReversibleFlag : 0U) |
                           (header.color_transform ? kColorTransformFlag : 0U);
    writer.write(static_cast<std::uint8_t>(flags | static_cast<unsigned>(header.levels) << 4U));
    writer.write(header.layers);
    writer.write_varint(header.width);
    writer.write_varint(header.height);
}

Result<TextureHeader> read_texture_header(ByteReader& reader)
{
    const auto flags = reader.read<std::uint8_t>();
    VSPLIT_TRY(flags);
    const auto layers = reader.read<std::uint8_t>();
    VSPLIT_TRY(layers);
    const auto width = reader.read_varint();
    VSPLIT_TRY(width);
    const auto height = reader.read_varint();
    VSPLIT_TRY(height);
    const auto in_range = [](std::uint64_t side) { return side >= 1 && side <= kMaxTextureSide; };
    if (!in_range(*width) || !in_range(*height))
    {
        return fail(ErrorCode::BadChunk, "an image has an impossible size");
    }
    TextureHeader header{
        .width = static_cast<std::uint32_t>(*width),
        .height = static_cast<std::uint32_t>(*height),
        .channels = static_cast<std::uint8_t>((*flags & 3U) + 1U),
        .reversible = (*flags & kReversibleFlag) != 0,
        .color_transform = (*flags & kColorTransformFlag) != 0,
        .levels = static_cast<std::uint8_t>(*flags >> 4U),
        .layers = *layers,
    };
    const std::uint32_t longest = std::max(header.width, header.height);
    if (header.levels > kMaxTextureLevels ||
        group_of_side(shifted_up(longest, header.levels)) != 0 || header.layers < 1 ||
        header.layers > kMaxTextureLayers || (header.color_transform && header.channels < 3))
    {
        return fail(ErrorCode::BadChunk, "an image is coded in a way that does not exist");
    }
    return header;
}

TextureLayout::TextureLayout(const TextureHeader& header)
{
    const unsigned precinct_log = precinct_side_log(header);
    for (unsigned resolution = 0; resolution <= header.levels; ++resolution)
    {
        const unsigned shift = header.levels - resolution;
        const std::uint32_t width = shifted_up(header.width, shift);
        const std::uint32_t height = shifted_up(header.height, shift);
        const std::uint32_t packets =
            header.channels * shifted_up(width, precinct_log) * shifted_up(height, precinct_log);
        resolutions_.push_back({
            .width = width,
            .height = height,
            .group = group_of_side(std::max(width, height)),
            .first_packet = packets_per_layer_,
            .packets = packets,
        });
        packets_per_layer_ += packets;
    }
    packet_count_ = std::uint64_t{packets_per_layer_} * header.layers;
}

unsigned TextureLayout::group_of(std::uint64_t packet) const
{
    const auto place = static_cast<std::uint32_t>(packet % packets_per_layer_);
    const auto next = std::upper_bound(
        resolutions_.begin(),
        resolutions_.end(),
        place,
        [](std::uint32_t value, const TextureResolution& r) { return value < r.first_packet; }
    );
    return std::prev(next)->group;
}

std::uint64_t TextureLayout::run_end(std::uint64_t packet) const
{
    const TextureResolution& last = resolutions_[finest_resolution(group_of(packet))];
    return packet - packet % packets_per_layer_ + last.first_packet + last.packets;
}

std::size_t TextureLayout::finest_resolution(unsigned group) const
{
    std::size_t finest = 0;
    while (finest + 1 < resolutions_.size() && resolutions_[finest + 1].group <= group)
    {
        ++finest;
    }
    return finest;
}

}  // namespace vsplit::image
