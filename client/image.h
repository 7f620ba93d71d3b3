#pragma once

#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vsplit::client {

/// A picture, rows from the top, 3 bytes a pixel (red, green, blue).
struct Image
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> pixels;  ///< 3 * width * height bytes.
};

/// Writes a picture as PNG; the file appears complete or not at all.
/// Precondition: image.pixels has the length its size asks for. Errors: IoError, Internal (libpng).
[[nodiscard]] Result<void> write_png(const std::filesystem::path& path, const Image& image);

}  // namespace vsplit::client
