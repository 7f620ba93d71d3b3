#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "image/texture_layout.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::image {

/// Codes an image with OpenJPEG.
/// `raster`: of the size and channels that `header` says; `layer_bytes`: for every layer the bytes of
/// the code stream up to its end, rising; 0 for all that there is.
/// Result: a code stream with packet lengths. Errors: Internal when OpenJPEG refuses.
/// Cost: some 0.1 s a megapixel and channel.
[[nodiscard]] Result<std::vector<std::byte>> open_jpeg_encode(
    const Raster& raster, const TextureHeader& header, std::span<const double> layer_bytes
);

/// Decodes a code stream whose main header is main_header().
/// `reduce`: how many of its finest resolutions not to decode. Precondition: no more than it has.
/// Errors: BadChunk when OpenJPEG refuses its packets. Safe on untrusted packets behind a trusted
/// main header.
[[nodiscard]] Result<Raster> open_jpeg_decode(std::span<const std::byte> stream, unsigned reduce);

}  // namespace vsplit::image
