#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace vsplit::precompute {

/// How an image file is compressed.
enum class ImageFormat : std::uint8_t
{
    Png,
    Jpeg,
};

/// What the first bytes of an image file say.
struct ImageHeader
{
    ImageFormat format = ImageFormat::Png;
    std::uint32_t width = 0;   ///< Pixels, 1 .. 32768.
    std::uint32_t height = 0;  ///< Pixels, 1 .. 32768.
    std::uint8_t channels =
        3;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA; palettes are looked through.
};

/// Reads size and channels of a PNG or JPEG file without decoding it.
/// `bytes`: the whole file. Result: nothing when it is neither, is cut off before they are known, has
/// sides beyond 32768 or other channels (CMYK). Cost: linear in the number of chunks before the pixels.
/// Thread safe. Safe on untrusted input.
/// Source: W3C, "PNG Specification", 2003; ITU-T T.81, 1992, annex B.
[[nodiscard]] std::optional<ImageHeader> read_image_header(std::span<const std::byte> bytes);

}  // namespace vsplit::precompute
