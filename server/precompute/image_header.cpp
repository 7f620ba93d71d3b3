// Based on: W3C, "PNG Specification", second edition, 2003, sections 5 and 11; ITU-T Recommendation
// T.81, "Digital compression and coding of continuous-tone still images", 1992, annex B.
#include "precompute/image_header.h"

#include <algorithm>
#include <array>

namespace vsplit::precompute {
namespace {

constexpr std::uint32_t kLargestSide = 32768;

/// Reads a big-endian number. Precondition: the bytes are there.
std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t offset, std::size_t size)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
    {
        value = (value << 8) | static_cast<std::uint32_t>(bytes[offset + i]);
    }
    return value;
}

bool is_side(std::uint32_t pixels)
{
    return pixels >= 1 && pixels <= kLargestSide;
}

/// Tells whether a palette has transparent colours: a chunk tRNS before the pixels.
bool has_transparency(std::span<const std::byte> bytes)
{
    constexpr std::uint32_t kTransparency = 0x74524E53;  // tRNS
    constexpr std::uint32_t kPixels = 0x49444154;        // IDAT
    constexpr std::size_t kAround = 12;                  // length, name and checksum of a chunk
    std::size_t offset = 8;
    while (bytes.size() - offset >= kAround)
    {
        const std::uint32_t name = big_endian(bytes, offset + 4, 4);
        const std::size_t length = big_endian(bytes, offset, 4);
        if (name == kTransparency || name == kPixels || length > bytes.size() - offset - kAround)
        {
            return name == kTransparency;
        }
        offset += kAround + length;
    }
    return false;
}

std::optional<ImageHeader> read_png(std::span<const std::byte> bytes)
{
    constexpr std::size_t kHeaderEnd = 33;
    constexpr std::uint32_t kHeaderName = 0x49484452;  // IHDR
    if (bytes.size() < kHeaderEnd || big_endian(bytes, 12, 4) != kHeaderName)
    {
        return std::nullopt;
    }
    ImageHeader header{ImageFormat::Png, big_endian(bytes, 16, 4), big_endian(bytes, 20, 4), 0};
    const std::uint8_t extra = has_transparency(bytes) ? 1 : 0;
    switch (big_endian(bytes, 25, 1))
    {
        case 0:
            header.channels = 1 + extra;
            break;
        case 2:
        case 3:
            header.channels = 3 + extra;
            break;
        case 4:
            header.channels = 2;
            break;
        case 6:
            header.channels = 4;
            break;
        default:
            return std::nullopt;
    }
    return header;
}

/// Walks over the segments of a JPEG file up to the one that starts a frame.
std::optional<ImageHeader> read_jpeg(std::span<const std::byte> bytes)
{
    std::size_t offset = 2;
    while (bytes.size() - offset >= 4)
    {
        const std::uint32_t mark = big_endian(bytes, offset, 2);
        if (mark == 0xFFFF)
        {
            ++offset;  // fill byte
            continue;
        }
        const std::size_t length = big_endian(bytes, offset + 2, 2);
        if (mark < 0xFFC0 || length < 2 || length > bytes.size() - offset - 2)
        {
            return std::nullopt;
        }
        // SOF0 .. SOF15 but for DHT, JPG and DAC.
        const bool starts = mark <= 0xFFCF && mark != 0xFFC4 && mark != 0xFFC8 && mark != 0xFFCC;
        if (starts && length >= 8)
        {
            const std::uint32_t channels = big_endian(bytes, offset + 9, 1);
            return ImageHeader{
                ImageFormat::Jpeg,
                big_endian(bytes, offset + 7, 2),
                big_endian(bytes, offset + 5, 2),
                static_cast<std::uint8_t>(channels)};
        }
        offset += 2 + length;
    }
    return std::nullopt;
}

}  // namespace

std::optional<ImageHeader> read_image_header(std::span<const std::byte> bytes)
{
    constexpr std::array<std::uint8_t, 8> kPng{0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
    const auto starts_with = [&](std::span<const std::uint8_t> magic) {
        return bytes.size() >= magic.size() &&
               std::equal(magic.begin(), magic.end(), bytes.begin(), [](auto want, std::byte have) {
                   return want == static_cast<std::uint8_t>(have);
               });
    };
    constexpr std::array<std::uint8_t, 3> kJpeg{0xFF, 0xD8, 0xFF};
    std::optional<ImageHeader> header;
    if (starts_with(kPng))
    {
        header = read_png(bytes);
    }
    else if (starts_with(kJpeg))
    {
        header = read_jpeg(bytes);
        header = header && header->channels != 1 && header->channels != 3 ? std::nullopt : header;
    }
    return header && is_side(header->width) && is_side(header->height) ? header : std::nullopt;
}

}  // namespace vsplit::precompute
