// Based on: Osada, Funkhouser, Chazelle, Dobkin, "Shape Distributions", 2002, section 3 (uniform points
// on a triangle); Cignoni, Rocchini, Scopigno, "Metro: Measuring Error on Simplified Surfaces", 1998
// (distance of two surfaces by sampling both directions).
#include "mesh/surface_distance.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace vsplit {
namespace {

using Point = std::array<float, 3>;
using Vector = std::array<double, 3>;

/// Bits per axis of a Morton code; three axes fit 30 bits.
constexpr int kMortonBits = 10;

Vector difference(const Point& a, const Point& b)
{
    return {
        static_cast<double>(a[0]) - b[0],
        static_cast<double>(a[1]) - b[1],
        static_cast<double>(a[2]) - b[2]};
}

double double_area(std::span<const Point> positions, const Triangle& triangle)
{
    const Vector u = difference(positions[triangle[1]], positions[triangle[0]]);
    const Vector v = difference(positions[triangle[2]], positions[triangle[0]]);
    const double x = u[1] * v[2] - u[2] * v[1];
    const double y = u[2] * v[0] - u[0] * v[2];
    const double z = u[0] * v[1] - u[1] * v[0];
    return std::sqrt(x * x + y * y + z * z);
}

/// Uniform numbers in [0, 1) that depend on nothing but a counter (SplitMix64, Steele, Lea, Flood
/// 2014): standard distributions differ between libraries.
class UniformNumbers
{
public:
    double next()
    {
        state_ += 0x9E37'79B9'7F4A'7C15ULL;
        std::uint64_t bits = state_;
        bits = (bits ^ (bits >> 30)) * 0xBF58'476D'1CE4'E5B9ULL;
        bits = (bits ^ (bits >> 27)) * 0x94D0'49BB'1331'11EBULL;
        bits ^= bits >> 31;
        return static_cast<double>(bits >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 12345;
};

/// Osada et al., equation 1: P = (1 - sqrt(r1)) A + sqrt(r1) (1 - r2) B + sqrt(r1) r2 C.
Point point_on_triangle(
    std::span<const Point> positions, const Triangle& triangle, double r1, double r2
)
{
    const double root = std::sqrt(r1);
    const Point& a = positions[triangle[0]];
    const Point& b = positions[triangle[1]];
    const Point& c = positions[triangle[2]];
    Point point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        point[axis] = static_cast<float>(
            (1.0 - root) * a[axis] + root * (1.0 - r2) * b[axis] + root * r2 * c[axis]
        );
    }
    return point;
}

/// Spreads the low 10 bits of a number to every third bit.
std::uint32_t spread_bits(std::uint32_t value)
{
    value = (value | (value << 16)) & 0x0300'00FFU;
    value = (value | (value << 8)) & 0x0300'F00FU;
    value = (value | (value << 4)) & 0x030C'30C3U;
    return (value | (value << 2)) & 0x0924'9249U;
}

std::vector<SurfaceSample> in_morton_order(const std::vector<SurfaceSample>& samples)
{
    Point low = samples.front().point;
    Point high = low;
    for (const auto& [point, triangle] : samples)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    }
    const float extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    const float scale = extent > 0.0F ? ((1 << kMortonBits) - 1) / extent : 0.0F;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order(samples.size());
    for (std::uint32_t i = 0; i < samples.size(); ++i)
    {
        std::uint32_t code = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float cell = std::clamp(
                (samples[i].point[axis] - low[axis]) * scale,
                0.0F,
                static_cast<float>((1 << kMortonBits) - 1)
            );
            code = code << 1 | spread_bits(static_cast<std::uint32_t>(cell));
        }
        order[i] = {code, i};
    }
    std::sort(order.begin(), order.end());
    std::vector<SurfaceSample> sorted(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        sorted[i] = samples[order[i].second];
    }
    return sorted;
}

struct OneWay
{
    double mean_square = 0.0;
    double max_square = 0.0;
};

OneWay measure_one_way(const std::vector<SurfaceSample>& samples, const ClosestPointTree& tree)
{
    OneWay result;
    std::uint32_t hint = 0;
    for (const auto& [point, triangle] : samples)
    {
        const double square = tree.squared_distance(point, hint);
        result.mean_square += square;
        result.max_square = std::max(result.max_square, square);
    }
    result.mean_square /= static_cast<double>(samples.size());
    return result;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(
    std::span<const std::array<float, 3>> positions,
    std::span<const Triangle> triangles,
    std::size_t count
)
{
    VSPLIT_ASSERT(!triangles.empty());
    std::vector<double> area_up_to(triangles.size());
    double total = 0.0;
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
        total += double_area(positions, triangles[i]);
        area_up_to[i] = total;
    }
    std::vector<SurfaceSample> samples(count);
    UniformNumbers uniform;
    std::size_t current = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        // One sample in each of `count` strata of equal area, in the order of the triangles.
        const double target =
            (static_cast<double>(i) + uniform.next()) / static_cast<double>(count) * total;
        while (current + 1 < triangles.size() && area_up_to[current] <= target)
        {
            ++current;
        }
        const double r1 = uniform.next();
        const double r2 = uniform.next();
        samples[i] = {
            point_on_triangle(positions, triangles[current], r1, r2),
            static_cast<std::uint32_t>(current)};
    }
    return samples.empty() ? samples : in_morton_order(samples);
}

DistanceReference::DistanceReference(
    std::span<const std::array<float, 3>> positions,
    std::span<const Triangle> triangles,
    std::size_t samples
)
    : samples_(sample_surface(positions, triangles, samples)), tree_(positions, triangles)
{
    VSPLIT_ASSERT(samples > 0);
}

SurfaceDistance DistanceReference::measure(
    std::span<const std::array<float, 3>> positions, std::span<const Triangle> triangles
) const
{
    const ClosestPointTree other(positions, triangles);
    const OneWay there = measure_one_way(samples_, other);
    const OneWay back =
        measure_one_way(sample_surface(positions, triangles, samples_.size()), tree_);
    return {
        .rms = std::sqrt(std::max(there.mean_square, back.mean_square)),
        .max = std::sqrt(std::max(there.max_square, back.max_square)),
    };
}

}  // namespace vsplit
