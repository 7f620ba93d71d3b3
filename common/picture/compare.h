#pragma once

#include "picture/picture.h"

#include <cstdint>

namespace vsplit::picture {

/// What of two pictures is compared.
enum class Region : std::uint8_t
{
    Silhouettes,  ///< Pixels that at least one of them covers.
    All,          ///< Every pixel, the background, too.
};

/// How different two pictures are.
struct Difference
{
    double mse = 0.0;   ///< Mean squared difference of the channels, 0 .. 65025.
    double psnr = 0.0;  ///< Peak signal-to-noise ratio, dB; kSamePsnr when there is no difference.
    double ssim = 1.0;  ///< Structural similarity of the brightness, at most 1.
};

/// What Difference::psnr says of equal pictures, and at most.
constexpr double kSamePsnr = 99.0;

/// The PSNR of a mean squared difference, dB.
[[nodiscard]] double psnr_of(double mse);

/// Sums the squared differences of all channels in a region, and counts the pixels.
struct SquaredDifference
{
    std::uint64_t sum = 0;     ///< Over pixels and channels.
    std::uint64_t pixels = 0;  ///< In the region.

    /// Mean over pixels and channels; 0 when the region is empty. An exact quotient of integers.
    [[nodiscard]] double mean() const
    {
        return pixels == 0 ? 0.0 : static_cast<double>(sum) / (3.0 * static_cast<double>(pixels));
    }
};

/// Measures the squared difference alone: exact integers. Preconditions as compare(). Thread safe.
[[nodiscard]] SquaredDifference squared_difference(
    const Picture& a, const Picture& b, Region region
);

/// Compares two pictures of the same view. SSIM is the mean over windows of 8 by 8 pixels, one every four
/// pixels, that touch the region. Precondition: same size, both coloured. Thread safe.
/// Source: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
/// Structural Similarity", 2004.
[[nodiscard]] Difference compare(const Picture& a, const Picture& b, Region region);

}  // namespace vsplit::picture
