// Based on: Williams, "Pyramidal Parametrics", 1983.
#include "picture/texture.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace vsplit::picture {
namespace {

/// Coordinates beyond are no picture of anything; within, they fit integers.
constexpr double kFarthest = 1048576.0;

std::array<std::uint8_t, 4> widen(const std::uint8_t* pixel, std::uint8_t channels)
{
    switch (channels)
    {
        case 1:
            return {pixel[0], pixel[0], pixel[0], 255};
        case 2:
            return {pixel[0], pixel[0], pixel[0], pixel[1]};
        case 3:
            return {pixel[0], pixel[1], pixel[2], 255};
        default:
            return {pixel[0], pixel[1], pixel[2], pixel[3]};
    }
}

/// The pixel of a row (or column) of `size` that a coordinate beyond it stands for.
std::size_t wrap(std::int64_t pixel, std::int64_t size, TextureWrap mode)
{
    if (mode == TextureWrap::Clamp)
    {
        return static_cast<std::size_t>(std::clamp<std::int64_t>(pixel, 0, size - 1));
    }
    const std::int64_t period = mode == TextureWrap::Mirror ? 2 * size : size;
    const std::int64_t inside = ((pixel % period) + period) % period;
    return static_cast<std::size_t>(inside < size ? inside : period - 1 - inside);
}

double bounded(double coordinate)
{
    return std::abs(coordinate) < kFarthest ? coordinate : 0.0;
}

Rgba blend(const Rgba& a, const Rgba& b, double share)
{
    Rgba result{};
    for (std::size_t k = 0; k < 4; ++k)
    {
        result[k] = a[k] + share * (b[k] - a[k]);
    }
    return result;
}

Rgba to_numbers(const std::array<std::uint8_t, 4>& pixel)
{
    return {
        static_cast<double>(pixel[0]),
        static_cast<double>(pixel[1]),
        static_cast<double>(pixel[2]),
        static_cast<double>(pixel[3])};
}

}  // namespace

Texture::Texture(const Raster& image)
{
    if (image.pixels.empty())
    {
        return;
    }
    const std::size_t count = std::size_t{image.width} * image.height;
    VSPLIT_ASSERT(image.pixels.size() == count * image.channels);
    Level level{image.width, image.height, {}};
    level.pixels.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        level.pixels.push_back(widen(&image.pixels[i * image.channels], image.channels));
    }
    levels_.push_back(std::move(level));
    while (levels_.back().width > 1 || levels_.back().height > 1)
    {
        levels_.push_back(halve(levels_.back()));
    }
}

Texture::Level Texture::halve(const Level& level)
{
    Level half{std::max(level.width / 2, 1U), std::max(level.height / 2, 1U), {}};
    half.pixels.reserve(std::size_t{half.width} * half.height);
    for (std::uint32_t y = 0; y < half.height; ++y)
    {
        for (std::uint32_t x = 0; x < half.width; ++x)
        {
            const std::size_t left = std::min(2 * x, level.width - 1);
            const std::size_t right = std::min(2 * x + 1, level.width - 1);
            const std::size_t top = std::size_t{std::min(2 * y, level.height - 1)} * level.width;
            const std::size_t low =
                std::size_t{std::min(2 * y + 1, level.height - 1)} * level.width;
            auto& pixel = half.pixels.emplace_back();
            for (std::size_t k = 0; k < 4; ++k)
            {
                const int sum = level.pixels[top + left][k] + level.pixels[top + right][k] +
                                level.pixels[low + left][k] + level.pixels[low + right][k];
                pixel[k] = static_cast<std::uint8_t>((sum + 2) / 4);
            }
        }
    }
    return half;
}

Rgba Texture::sample_level(const Level& level, double u, double v, const TextureUse& use)
{
    const double x = bounded(u) * level.width - 0.5;
    const double y = bounded(v) * level.height - 0.5;
    const auto column = static_cast<std::int64_t>(std::floor(x));
    const auto row = static_cast<std::int64_t>(std::floor(y));
    const std::size_t left = wrap(column, level.width, use.wrap_u);
    const std::size_t right = wrap(column + 1, level.width, use.wrap_u);
    const std::size_t top = wrap(row, level.height, use.wrap_v) * level.width;
    const std::size_t low = wrap(row + 1, level.height, use.wrap_v) * level.width;
    const double share = x - std::floor(x);
    const auto above =
        blend(to_numbers(level.pixels[top + left]), to_numbers(level.pixels[top + right]), share);
    const auto below =
        blend(to_numbers(level.pixels[low + left]), to_numbers(level.pixels[low + right]), share);
    return blend(above, below, y - std::floor(y));
}

Rgba Texture::sample(double u, double v, const TextureUse& use, double footprint) const
{
    VSPLIT_ASSERT(!empty());
    std::size_t level = 0;
    double step = footprint;  // in pixels of the level, squared
    while (step >= 4.0 && level + 1 < levels_.size())
    {
        step /= 4.0;
        ++level;
    }
    const Rgba fine = sample_level(levels_[level], u, v, use);
    if (!(step > 1.0) || level + 1 == levels_.size())
    {
        return fine;
    }
    // Linear in the step instead of its logarithm, which machines do not agree on.
    return blend(fine, sample_level(levels_[level + 1], u, v, use), std::sqrt(step) - 1.0);
}

}  // namespace vsplit::picture
