#pragma once

#include "image/raster.h"

#include <cstdint>

namespace vsplit::image {

/// Returns an image scaled down so that no side is longer than `max_size`; a smaller one comes back
/// as it is. Every pixel is the mean of the area of the source that it covers.
/// Preconditions: the raster has pixels, `max_size` >= 1. Cost: linear in the source's pixels.
[[nodiscard]] Raster downsampled(const Raster& raster, std::uint32_t max_size);

}  // namespace vsplit::image
