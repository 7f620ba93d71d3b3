#include "image/sample_raster.h"

#include <cmath>
#include <cstddef>

namespace vsplit::test {

Raster sample_raster(std::uint32_t width, std::uint32_t height, std::uint8_t channels)
{
    Raster raster{.width = width, .height = height, .channels = channels, .pixels = {}};
    std::uint32_t noise = 12345;
    for (std::uint32_t y = 0; y < height; ++y)
    {
        for (std::uint32_t x = 0; x < width; ++x)
        {
            const double u = (x + 0.5) / width - 0.5;
            const double v = (y + 0.5) / height - 0.5;
            const bool inside = u * u + v * v < 0.16;
            for (std::uint8_t channel = 0; channel < channels; ++channel)
            {
                noise = noise * 1664525U + 1013904223U;
                const double wave = std::sin(9.0 * u * (channel + 1)) * std::cos(7.0 * v);
                double value = 128.0 + 70.0 * wave + (inside ? 40.0 : -20.0) + (noise >> 29U);
                if (channels % 2 == 0 && channel + 1 == channels)
                {
                    value = inside ? 255.0 : 0.0;
                }
                raster.pixels.push_back(static_cast<std::uint8_t>(value));
            }
        }
    }
    return raster;
}

double squared_error(const Raster& a, const Raster& b)
{
    if (a.width != b.width || a.height != b.height || a.channels != b.channels ||
        a.pixels.size() != b.pixels.size())
    {
        return 1e9;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
    {
        const double difference = double{1} * a.pixels[i] - b.pixels[i];
        sum += difference * difference;
    }
    return sum / static_cast<double>(a.pixels.size());
}

}  // namespace vsplit::test
