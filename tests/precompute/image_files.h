#pragma once

#include "precompute/mesh_io.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::test {

/// A whole PNG file of 1 x 1 RGB pixel.
inline std::string tiny_png()
{
    constexpr std::array<unsigned char, 69> kBytes{
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
        0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
        0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x08,
        0xd7, 0x63, 0xf8, 0xcf, 0xc0, 0x00, 0x00, 0x03, 0x01, 0x01, 0x00, 0x18, 0xdd, 0x8d,
        0xb0, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    return {reinterpret_cast<const char*>(kBytes.data()), kBytes.size()};
}

/// The start of a progressive JPEG file of 640 x 480 pixels, up to its frame header.
inline std::string jpeg_start(std::uint8_t channels = 3)
{
    std::string bytes("\xFF\xD8\xFF\xE0\x00\x04\x00\x00\xFF\xC2\x00\x11\x08\x01\xE0\x02\x80", 17);
    bytes.push_back(static_cast<char>(channels));
    bytes.append(9, '\0');
    return bytes;
}

/// A text as bytes.
inline std::span<const std::byte> bytes_of(std::string_view text)
{
    return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace vsplit::test
