// Based on: ISO/IEC 15444-1, JPEG 2000 image coding system: core coding system, annexes A, B and E.
#include "image/code_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace vsplit::image {

namespace {

constexpr std::uint16_t kStartOfCodeStream = 0xFF4F;
constexpr std::uint16_t kSize = 0xFF51;
constexpr std::uint16_t kCodingStyle = 0xFF52;
constexpr std::uint16_t kQuantization = 0xFF5C;
constexpr std::uint16_t kComment = 0xFF64;
constexpr std::uint16_t kStartOfTilePart = 0xFF90;
constexpr std::uint16_t kPacketLengths = 0xFF58;
constexpr std::uint16_t kStartOfData = 0xFF93;
constexpr std::uint16_t kEndOfCodeStream = 0xFFD9;
constexpr std::size_t kTilePartHeaderBytes = 12;
constexpr int kBitDepth = 8;

/// Norms of the 9/7 synthesis basis by orientation (LL, HL, LH, HH) and level. OpenJPEG's table: with
/// steps of one over the norm an error in any band weighs the same.
constexpr std::array<std::array<double, 10>, 4> kNorms{{
    {1.000, 1.965, 4.177, 8.403, 16.90, 33.84, 67.69, 135.3, 270.6, 540.9},
    {2.022, 3.989, 8.355, 17.04, 34.27, 68.63, 137.3, 274.6, 549.0, 549.0},
    {2.022, 3.989, 8.355, 17.04, 34.27, 68.63, 137.3, 274.6, 549.0, 549.0},
    {2.080, 3.865, 8.307, 17.18, 34.71, 69.59, 139.3, 278.6, 557.2, 557.2},
}};

/// Appends big-endian fields, as JPEG 2000 has them.
class BigEndianWriter
{
public:
    explicit BigEndianWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}

    template <typename T>
    void write(T value)
    {
        for (std::size_t i = sizeof(T); i-- > 0;)
        {
            bytes_.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xFFU));
        }
    }

private:
    std::vector<std::byte>& bytes_;
};

std::uint32_t big_endian(std::span<const std::byte> bytes)
{
    std::uint32_t value = 0;
    for (const std::byte byte : bytes)
    {
        value = value << 8U | static_cast<std::uint32_t>(byte);
    }
    return value;
}

/// Exponent and mantissa of a quantisation step (equation E-3).
std::uint16_t coded_step(double step)
{
    const auto fixed = static_cast<std::uint32_t>(std::floor(step * 8192.0));
    const int log = static_cast<int>(std::bit_width(fixed)) - 1;
    const std::uint32_t mantissa = (log > 11 ? fixed >> (log - 11) : fixed << (11 - log)) & 0x7FFU;
    return static_cast<std::uint16_t>(
        static_cast<unsigned>(kBitDepth - (log - 13)) << 11U | mantissa
    );
}

void write_size(const TextureHeader& header, unsigned dropped, BigEndianWriter& writer)
{
    const TextureLayout layout(header);
    const auto& size = layout.resolutions()[header.levels - dropped];
    writer.write(kSize);
    writer.write(static_cast<std::uint16_t>(38 + 3 * header.channels));
    writer.write(std::uint16_t{0});
    for (const std::uint32_t value : {size.width, size.height, 0U, 0U, size.width, size.height})
    {
        writer.write(value);
    }
    writer.write(std::uint64_t{0});  // the tile's offset
    writer.write(static_cast<std::uint16_t>(header.channels));
    for (unsigned channel = 0; channel < header.channels; ++channel)
    {
        writer.write(static_cast<std::uint8_t>(kBitDepth - 1));
        writer.write(std::uint16_t{0x0101});  // not subsampled
    }
}

void write_coding_style(
    const TextureHeader& header, unsigned dropped, unsigned layers, BigEndianWriter& writer
)
{
    const unsigned levels = header.levels - dropped;
    const unsigned precinct = precinct_side_log(header);
    writer.write(kCodingStyle);
    writer.write(static_cast<std::uint16_t>(12 + levels + 1));
    writer.write(std::uint8_t{1});  // precincts follow
    writer.write(std::uint8_t{0});  // layer, resolution, component, position
    writer.write(static_cast<std::uint16_t>(layers));
    writer.write(static_cast<std::uint8_t>(header.color_transform ? 1 : 0));
    writer.write(static_cast<std::uint8_t>(levels));
    writer.write(std::uint16_t{0x0404});  // code blocks of 64 * 64
    writer.write(std::uint8_t{0});        // code block style
    writer.write(static_cast<std::uint8_t>(header.reversible ? 1 : 0));
    for (unsigned resolution = 0; resolution <= levels; ++resolution)
    {
        writer.write(static_cast<std::uint8_t>(precinct << 4U | precinct));
    }
}

void write_quantization(const TextureHeader& header, unsigned dropped, BigEndianWriter& writer)
{
    const unsigned bands = 1 + 3 * (header.levels - dropped);
    writer.write(kQuantization);
    writer.write(static_cast<std::uint16_t>(3 + bands * (header.reversible ? 1 : 2)));
    writer.write(static_cast<std::uint8_t>(2U << 5U | (header.reversible ? 0U : 2U)));
    for (unsigned band = 0; band < bands; ++band)
    {
        const unsigned orientation = band == 0 ? 0 : (band - 1) % 3 + 1;
        const unsigned level = header.levels - (band == 0 ? 0 : (band - 1) / 3 + 1);
        if (header.reversible)
        {
            const unsigned gain = (orientation + 1) / 2;  // 0 1 1 2
            writer.write(static_cast<std::uint8_t>((kBitDepth + gain) << 3U));
        }
        else
        {
            writer.write(coded_step(1.0 / kNorms[orientation][level]));
        }
    }
}

tl::unexpected<Error> unexpected_structure(std::size_t offset)
{
    return fail(ErrorCode::Internal, "OpenJPEG wrote an unexpected code stream", offset);
}

/// Reads the lengths of one PLT marker segment (A.7.3): seven bits a byte, most significant first.
void read_lengths(std::span<const std::byte> segment, std::vector<std::uint32_t>& lengths)
{
    std::uint32_t value = 0;
    for (const std::byte byte : segment)
    {
        value = value << 7U | (static_cast<std::uint32_t>(byte) & 0x7FU);
        if ((byte & std::byte{0x80}) == std::byte{0})
        {
            lengths.push_back(value);
            value = 0;
        }
    }
}

/// Steps over marker segments from `at` until `last`, handing each to `visit(marker, contents)`; gives
/// the place of `last`, or nothing when the segments do not lead there.
template <typename Visit>
std::size_t walk_segments(
    std::span<const std::byte> stream, std::size_t at, std::uint16_t last, const Visit& visit
)
{
    while (at + 4 <= stream.size())
    {
        const std::uint32_t marker = big_endian(stream.subspan(at, 2));
        const std::uint32_t length = big_endian(stream.subspan(at + 2, 2));
        if (marker == last)
        {
            return at;
        }
        if (length < 2 || length > stream.size() - at - 2)
        {
            break;
        }
        visit(marker, stream.subspan(at, length + 2));
        at += length + 2;
    }
    return 0;
}

}  // namespace

unsigned precinct_side_log(const TextureHeader& header)
{
    return header.reversible ? 8 : 9;
}

std::vector<std::byte> main_header(const TextureHeader& header, unsigned dropped, unsigned layers)
{
    std::vector<std::byte> bytes;
    BigEndianWriter writer(bytes);
    writer.write(kStartOfCodeStream);
    write_size(header, dropped, writer);
    write_coding_style(header, dropped, layers, writer);
    write_quantization(header, dropped, writer);
    return bytes;
}

void append_tile(std::vector<std::byte>& stream, std::span<const std::byte> packets)
{
    BigEndianWriter writer(stream);
    writer.write(kStartOfTilePart);
    writer.write(std::uint16_t{10});
    writer.write(std::uint16_t{0});  // tile
    writer.write(static_cast<std::uint32_t>(kTilePartHeaderBytes + 2 + packets.size()));
    writer.write(std::uint16_t{0x0001});  // part 0 of 1
    writer.write(kStartOfData);
    stream.insert(stream.end(), packets.begin(), packets.end());
    writer.write(kEndOfCodeStream);
}

Result<CodedPackets> split_code_stream(
    std::span<const std::byte> stream, const TextureHeader& header
)
{
    std::vector<std::byte> head(
        stream.begin(), stream.begin() + std::min<std::size_t>(2, stream.size())
    );
    const std::size_t tile =
        walk_segments(stream, 2, kStartOfTilePart, [&](std::uint32_t marker, auto segment) {
            if (marker != kComment)
            {
                head.insert(head.end(), segment.begin(), segment.end());
            }
        });
    if (tile == 0 || head != main_header(header, 0, header.layers))
    {
        return unexpected_structure(tile);
    }
    CodedPackets coded;
    const std::size_t data = walk_segments(
        stream,
        tile + kTilePartHeaderBytes,
        kStartOfData,
        [&](std::uint32_t marker, auto segment) {
            if (marker == kPacketLengths && segment.size() > 5)
            {
                read_lengths(segment.subspan(5), coded.lengths);
            }
        }
    );
    std::uint64_t total = 0;
    for (const std::uint32_t length : coded.lengths)
    {
        total += length;
    }
    if (data == 0 || coded.lengths.size() != TextureLayout(header).packet_count() ||
        data + 2 + total + 2 != stream.size())
    {
        return unexpected_structure(data);
    }
    const auto packets = stream.subspan(data + 2, total);
    coded.bytes.assign(packets.begin(), packets.end());
    return coded;
}

}  // namespace vsplit::image
