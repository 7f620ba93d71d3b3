#pragma once

#include "image/image_file.h"

namespace vsplit::image {

/// How far into a file to go.
enum class Extent
{
    Header,  ///< Size and channels only; the raster has no pixels.
    All,
};

/// Reads a PNG file, see read_image(). Safe on untrusted input.
[[nodiscard]] Result<Raster> read_png(
    std::span<const std::byte> bytes, const ImageLimits& limits, Extent extent
);

/// Reads a JPEG file, see read_image(). Safe on untrusted input.
[[nodiscard]] Result<Raster> read_jpeg(
    std::span<const std::byte> bytes, const ImageLimits& limits, Extent extent
);

/// Checks a size against limits. Error: InputTooLarge.
[[nodiscard]] Result<void> check_size(
    std::uint64_t width, std::uint64_t height, const ImageLimits& limits
);

}  // namespace vsplit::image
