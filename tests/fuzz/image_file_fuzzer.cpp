// Feeds noise to the readers of PNG and JPEG files.

#include "image/image_file.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace vsplit::image;
    const auto bytes = std::as_bytes(std::span(data, size));
    const ImageLimits limits{.max_side = 512, .max_pixels = 256U * 256U};
    const auto info = probe_image(bytes, limits);
    const auto raster = read_image(bytes, limits);
    const bool fits =
        !raster ||
        (info && raster->width == info->width && raster->height == info->height &&
         raster->channels == info->channels &&
         raster->pixels.size() == std::size_t{info->width} * info->height * info->channels);
    if (!fits)
    {
        std::abort();
    }
    return 0;
}
