#pragma once

#include "image/raster.h"
#include "scene/appearance.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::picture {

/// Red, green, blue and alpha, 0 .. 255.
using Rgba = std::array<double, 4>;

/// An image with its smaller copies.
/// Source: Williams, "Pyramidal Parametrics", 1983.
class Texture
{
public:
    /// No image: see empty().
    Texture() = default;

    /// Makes the smaller copies by halving down to one pixel. `image`: of any number of channels, or
    /// without pixels. Cost: linear in the pixels.
    explicit Texture(const Raster& image);

    /// True when there is no image.
    [[nodiscard]] bool empty() const { return levels_.empty(); }

    /// Pixels of the largest copy.
    [[nodiscard]] std::uint32_t width() const { return empty() ? 0 : levels_.front().width; }

    /// Pixels of the largest copy.
    [[nodiscard]] std::uint32_t height() const { return empty() ? 0 : levels_.front().height; }

    /// Samples at texture coordinates, the origin at the upper left corner: linear between pixels
    /// and between the two copies next to the wanted size.
    /// `footprint`: pixels of the largest copy, squared, that lie between two neighbouring samples.
    /// Precondition: not empty; coordinates are finite.
    [[nodiscard]] Rgba sample(double u, double v, const TextureUse& use, double footprint) const;

private:
    struct Level
    {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::vector<std::array<std::uint8_t, 4>> pixels;
    };

    static Level halve(const Level& level);
    static Rgba sample_level(const Level& level, double u, double v, const TextureUse& use);

    std::vector<Level> levels_;
};

}  // namespace vsplit::picture
