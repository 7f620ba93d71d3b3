#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit {

/// An image in memory, rows from the top, eight bits a channel.
struct Raster
{
    std::uint32_t width = 0;   ///< Pixels.
    std::uint32_t height = 0;  ///< Pixels.
    std::uint8_t channels =
        3;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA; alpha is not multiplied in.
    std::vector<std::uint8_t> pixels;  ///< width * height * channels.

    /// Memberwise equality.
    friend bool operator==(const Raster&, const Raster&) = default;
};

}  // namespace vsplit
