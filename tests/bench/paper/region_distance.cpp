// Based on: Cignoni, Rocchini, Scopigno, "Metro: Measuring Error on Simplified Surfaces", 1998.
#include "paper/region_distance.h"

#include "mesh/closest_point_tree.h"
#include "mesh/surface_distance.h"
#include "paper/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace vsplit::bench {
namespace {

using FloatPoint = std::array<float, 3>;

Vector3 to_double(const FloatPoint& point)
{
    return {point[0], point[1], point[2]};
}

/// A surface with what measuring needs.
class Surface
{
public:
    explicit Surface(const IndexedMesh& mesh)
        : positions_(to_floats(mesh)), triangles_(mesh.triangles), tree_(positions_, triangles_)
    {
    }

    [[nodiscard]] std::vector<SurfaceSample> sample(std::size_t count) const
    {
        return sample_surface(positions_, triangles_, count);
    }

    /// Squared distance, and the triangle that is closest.
    [[nodiscard]] double squared_distance(const FloatPoint& point, std::uint32_t& triangle) const
    {
        return static_cast<double>(tree_.squared_distance(point, triangle));
    }

    [[nodiscard]] Vector3 normal(std::uint32_t triangle) const
    {
        const auto& [a, b, c] = triangles_[triangle];
        const Vector3 origin = to_double(positions_[a]);
        return cross(to_double(positions_[b]) - origin, to_double(positions_[c]) - origin);
    }

    [[nodiscard]] double diagonal() const
    {
        FloatPoint low = positions_.front();
        FloatPoint high = low;
        for (const FloatPoint& point : positions_)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                low[k] = std::min(low[k], point[k]);
                high[k] = std::max(high[k], point[k]);
            }
        }
        const Vector3 size = to_double(high) - to_double(low);
        return std::sqrt(dot(size, size));
    }

private:
    static std::vector<FloatPoint> to_floats(const IndexedMesh& mesh)
    {
        std::vector<FloatPoint> result;
        for (const auto& [x, y, z] : mesh.positions)
        {
            result.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        }
        return result;
    }

    std::vector<FloatPoint> positions_;
    std::vector<Triangle> triangles_;
    ClosestPointTree tree_;
};

double angle_between(const Vector3& a, const Vector3& b)
{
    const double product = std::sqrt(dot(a, a) * dot(b, b));
    const double cosine = product > 0.0 ? std::clamp(dot(a, b) / product, -1.0, 1.0) : 1.0;
    return std::acos(cosine) * 180.0 / std::numbers::pi;
}

/// Root of a mean; 0 of nothing.
class RootMean
{
public:
    void add(double square)
    {
        sum_ += square;
        ++count_;
    }

    [[nodiscard]] double value() const
    {
        return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0.0;
    }

private:
    double sum_ = 0.0;
    std::size_t count_ = 0;
};

RegionDistance one_way(
    const Surface& from,
    const Surface& to,
    std::size_t samples,
    const std::optional<precompute::KeepSphere>& ball
)
{
    RootMean all;
    RootMean inside;
    RootMean outside;
    RegionDistance result;
    std::uint32_t hit = 0;
    for (const auto& [point, own] : from.sample(samples))
    {
        const double square = to.squared_distance(point, hit);
        all.add(square);
        result.max = std::max(result.max, std::sqrt(square));
        result.normals +=
            angle_between(from.normal(own), to.normal(hit)) / static_cast<double>(samples);
        bool in_ball = false;
        if (ball)
        {
            const Vector3 off = to_double(point) - ball->centre;
            in_ball = dot(off, off) <= ball->radius * ball->radius;
        }
        (in_ball ? inside : outside).add(square);
    }
    result.rms = all.value();
    result.inside = inside.value();
    result.outside = outside.value();
    return result;
}

}  // namespace

RegionDistance region_distance(
    const IndexedMesh& original,
    const IndexedMesh& shown,
    std::size_t samples,
    const std::optional<precompute::KeepSphere>& ball
)
{
    const Surface first(original);
    const Surface second(shown);
    const RegionDistance there = one_way(first, second, samples, ball);
    const RegionDistance back = one_way(second, first, samples, ball);
    return {
        .rms = std::max(there.rms, back.rms),
        .max = std::max(there.max, back.max),
        .normals = 0.5 * (there.normals + back.normals),
        .inside = std::max(there.inside, back.inside),
        .outside = std::max(there.outside, back.outside),
        .bounds = first.diagonal(),
    };
}

}  // namespace vsplit::bench
