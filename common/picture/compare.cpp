// Based on: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", 2004.
#include "picture/compare.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace vsplit::picture {
namespace {

constexpr std::uint32_t kWindow = 8;
constexpr std::uint32_t kStep = 4;
constexpr double kPeak = 255.0;

bool inside(const Picture& a, const Picture& b, std::size_t pixel, Region region)
{
    return region == Region::All || a.covered(pixel) || b.covered(pixel);
}

/// Brightness (ITU-R BT.601) in thousandths.
double brightness(const Picture& picture, std::size_t pixel)
{
    const std::uint8_t* const rgb = &picture.colors[3 * pixel];
    return static_cast<double>(299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2]) / 1000.0;
}

/// Sums over a window of both pictures.
struct WindowSums
{
    double a = 0.0;
    double b = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    double ab = 0.0;
    bool touches = false;  ///< The region.
};

WindowSums sum_window(
    const Picture& a, const Picture& b, Region region, std::uint32_t left, std::uint32_t top
)
{
    WindowSums sums;
    for (std::uint32_t y = top; y < top + kWindow; ++y)
    {
        for (std::uint32_t x = left; x < left + kWindow; ++x)
        {
            const std::size_t pixel = std::size_t{y} * a.size + x;
            const double of_a = brightness(a, pixel);
            const double of_b = brightness(b, pixel);
            sums.a += of_a;
            sums.b += of_b;
            sums.aa += of_a * of_a;
            sums.bb += of_b * of_b;
            sums.ab += of_a * of_b;
            sums.touches = sums.touches || inside(a, b, pixel, region);
        }
    }
    return sums;
}

/// Equation 13, with the constants of section III.C.
double similarity(const WindowSums& sums)
{
    constexpr double kCount = kWindow * kWindow;
    constexpr double kC1 = (0.01 * kPeak) * (0.01 * kPeak);
    constexpr double kC2 = (0.03 * kPeak) * (0.03 * kPeak);
    const double mean_a = sums.a / kCount;
    const double mean_b = sums.b / kCount;
    const double variance_a = sums.aa / kCount - mean_a * mean_a;
    const double variance_b = sums.bb / kCount - mean_b * mean_b;
    const double covariance = sums.ab / kCount - mean_a * mean_b;
    return (2.0 * mean_a * mean_b + kC1) * (2.0 * covariance + kC2) /
           ((mean_a * mean_a + mean_b * mean_b + kC1) * (variance_a + variance_b + kC2));
}

double mean_similarity(const Picture& a, const Picture& b, Region region)
{
    double sum = 0.0;
    std::size_t count = 0;
    for (std::uint32_t top = 0; top + kWindow <= a.size; top += kStep)
    {
        for (std::uint32_t left = 0; left + kWindow <= a.size; left += kStep)
        {
            const WindowSums sums = sum_window(a, b, region, left, top);
            if (sums.touches)
            {
                sum += similarity(sums);
                ++count;
            }
        }
    }
    return count == 0 ? 1.0 : sum / static_cast<double>(count);
}

}  // namespace

double psnr_of(double mse)
{
    return mse > 0.0 ? std::min(10.0 * std::log10(kPeak * kPeak / mse), kSamePsnr) : kSamePsnr;
}

SquaredDifference squared_difference(const Picture& a, const Picture& b, Region region)
{
    VSPLIT_ASSERT(a.size == b.size && a.colors.size() == b.colors.size() && !a.colors.empty());
    SquaredDifference result;
    for (std::size_t pixel = 0; pixel < a.triangles.size(); ++pixel)
    {
        if (!inside(a, b, pixel, region))
        {
            continue;
        }
        ++result.pixels;
        for (std::size_t k = 3 * pixel; k < 3 * pixel + 3; ++k)
        {
            const int step = a.colors[k] - b.colors[k];
            result.sum += static_cast<std::uint64_t>(step * step);
        }
    }
    return result;
}

Difference compare(const Picture& a, const Picture& b, Region region)
{
    Difference result;
    result.mse = squared_difference(a, b, region).mean();
    result.psnr = psnr_of(result.mse);
    result.ssim = mean_similarity(a, b, region);
    return result;
}

}  // namespace vsplit::picture
