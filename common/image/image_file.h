#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::image {

/// Bounds that are checked against an image file's header, before anything is decoded.
struct ImageLimits
{
    std::uint32_t max_side = 32768;
    std::uint64_t max_pixels = std::uint64_t{1} << 27U;
};

/// Reads size and channels of a PNG or JPEG file.
/// Errors: UnsupportedInput for other formats, four-colour JPEG and malformed files, InputTooLarge.
/// Safe on untrusted input.
[[nodiscard]] Result<ImageInfo> probe_image(
    std::span<const std::byte> bytes, const ImageLimits& limits = {}
);

/// Decodes a PNG or JPEG file: palettes become colours, 16 bits become 8, transparent colours become
/// an alpha channel; colour profiles, gamma and orientation are left alone, as glTF wants it.
/// Errors: those of probe_image(), Truncated. Cost: linear in the pixels. Safe on untrusted input.
[[nodiscard]] Result<Raster> read_image(
    std::span<const std::byte> bytes, const ImageLimits& limits = {}
);

/// Makes a PNG file. Precondition: pixels as many as the size says. Errors: Internal (libpng).
[[nodiscard]] Result<std::vector<std::byte>> write_png(const Raster& raster);

/// How to write a JPEG file.
struct JpegOptions
{
    int quality = 90;          ///< 1 .. 100, libjpeg's scale.
    bool subsampled = false;   ///< Chroma at half the resolution (4:2:0).
    bool progressive = false;  ///< In several scans; mostly some percent shorter.
};

/// Makes a JPEG file with optimal Huffman tables; alpha is left out.
/// Precondition: pixels as many as the size says. Errors: Internal (libjpeg).
[[nodiscard]] Result<std::vector<std::byte>> write_jpeg(
    const Raster& raster, const JpegOptions& options = {}
);

}  // namespace vsplit::image
