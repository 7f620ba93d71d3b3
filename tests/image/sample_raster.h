#pragma once

#include "image/raster.h"

#include <cstdint>

namespace vsplit::test {

/// An image with slopes, edges and some noise, always the same; alpha is a disc when `channels` is
/// even.
[[nodiscard]] Raster sample_raster(
    std::uint32_t width, std::uint32_t height, std::uint8_t channels
);

/// Mean of the squared differences; a large number for images of different shapes.
[[nodiscard]] double squared_error(const Raster& a, const Raster& b);

}  // namespace vsplit::test
