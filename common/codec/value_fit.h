#pragma once

// Based on: Isenburg, Snoeyink, "Compressing Texture Coordinates with Selective Linear Predictions", 2003;
// here a plane is fitted through all known values around a wedge instead of one parallelogram, with the
// positions known (weighted least squares).

#include "codec/attribute_state.h"
#include "codec/level_mesh.h"
#include "codec/wedge_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Three numbers in binary64.
using Double3 = std::array<double, 3>;

/// Inner product: (x x + y y) + z z.
[[nodiscard]] inline double dot(const Double3& a, const Double3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Vector product.
[[nodiscard]] inline Double3 cross(const Double3& a, const Double3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Difference of two positions.
[[nodiscard]] inline Double3 difference(
    const std::array<std::int32_t, 3>& a, const std::array<std::int32_t, 3>& b
)
{
    return {
        static_cast<double>(a[0] - b[0]),
        static_cast<double>(a[1] - b[1]),
        static_cast<double>(a[2] - b[2])};
}

/// What is expected of one number of a value.
struct ExpectedNumber
{
    double value = 0.0;
    double slope_squared = 0.0;  ///< Of the fitted plane.
    double error_squared = 0.0;  ///< Weighted mean over what it was fitted to.
};

/// Fits planes through the known values around a wedge, over its tangent plane. Reused from wedge to
/// wedge. Not thread safe.
/// Arithmetic: binary64, in the order written, see proto/STREAM_FORMAT.md, "Values".
class ValueFit
{
public:
    /// Looks at a wedge. `wedge_vertices`: by wedge its vertex.
    void look_at(
        const LevelMesh& mesh,
        const WedgeNeighbours& neighbours,
        std::span<const std::uint32_t> wedge_vertices,
        std::uint32_t wedge
    )
    {
        samples_.clear();
        const auto corners = neighbours.corners(wedge);
        collect(neighbours, corners);
        if (samples_.empty())
        {
            return;
        }
        const auto [first, second] = tangents(mesh, corners);
        const auto& centre = mesh.positions[wedge_vertices[wedge]];
        weight_ = sum_x_ = sum_y_ = xx_ = xy_ = yy_ = 0.0;
        for (Sample& sample : samples_)
        {
            const Double3 d = difference(mesh.positions[wedge_vertices[sample.wedge]], centre);
            sample.x = dot(d, first);
            sample.y = dot(d, second);
            sample.weight = sample.weight / (dot(d, d) + 1.0);
            weight_ = weight_ + sample.weight;
            sum_x_ = sum_x_ + sample.weight * sample.x;
            sum_y_ = sum_y_ + sample.weight * sample.y;
            xx_ = xx_ + sample.weight * sample.x * sample.x;
            xy_ = xy_ + sample.weight * sample.x * sample.y;
            yy_ = yy_ + sample.weight * sample.y * sample.y;
        }
        mean_x_ = sum_x_ / weight_;
        mean_y_ = sum_y_ / weight_;
        xx_ = xx_ - sum_x_ * mean_x_;
        xy_ = xy_ - sum_x_ * mean_y_;
        yy_ = yy_ - sum_y_ * mean_y_;
        const double ridge = kRidge * (xx_ + yy_) + kLeastRidge;
        xx_ = xx_ + ridge;
        yy_ = yy_ + ridge;
        determinant_ = xx_ * yy_ - xy_ * xy_;
    }

    /// Known wedges that the fit goes through.
    [[nodiscard]] std::size_t size() const { return samples_.size(); }

    /// Square of the distance at which they are, on the whole. Precondition: size() > 0.
    [[nodiscard]] double reach_squared() const
    {
        return static_cast<double>(samples_.size()) / weight_;
    }

    /// Expects number `k` of `numbers` of a value. `values`: by wedge. Precondition: size() > 0.
    [[nodiscard]] ExpectedNumber expect(
        std::span<const std::int32_t> values, std::size_t numbers, std::size_t k
    ) const
    {
        double sum = 0.0;
        double sum_x = 0.0;
        double sum_y = 0.0;
        for (const Sample& sample : samples_)
        {
            const double weighted = sample.weight * value_of(sample, values, numbers, k);
            sum = sum + weighted;
            sum_x = sum_x + weighted * sample.x;
            sum_y = sum_y + weighted * sample.y;
        }
        const double mean = sum / weight_;
        const double x = sum_x - mean * sum_x_;
        const double y = sum_y - mean * sum_y_;
        const double slope_x = (x * yy_ - y * xy_) / determinant_;
        const double slope_y = (y * xx_ - x * xy_) / determinant_;
        ExpectedNumber expected;
        expected.value = mean - slope_x * mean_x_ - slope_y * mean_y_;
        expected.slope_squared = slope_x * slope_x + slope_y * slope_y;
        double error = 0.0;
        for (const Sample& sample : samples_)
        {
            const double rest = value_of(sample, values, numbers, k) -
                                (expected.value + slope_x * sample.x + slope_y * sample.y);
            error = error + sample.weight * rest * rest;
        }
        expected.error_squared = error / weight_;
        return expected;
    }

private:
    static constexpr double kRidge = 0.0001;
    static constexpr double kLeastRidge = 1.0 / (1 << 30);
    static constexpr double kBeyondWeight = 0.3125;
    /// Bounds the time that a vertex with many neighbours takes.
    static constexpr std::size_t kMostSamples = 64;

    /// A known wedge near by.
    struct Sample
    {
        std::uint32_t wedge = 0;
        double weight = 1.0;
        double x = 0.0;
        double y = 0.0;
    };

    [[nodiscard]] static double value_of(
        const Sample& sample,
        std::span<const std::int32_t> values,
        std::size_t numbers,
        std::size_t k
    )
    {
        return static_cast<double>(values[sample.wedge * numbers + k]);
    }

    void add(const WedgeNeighbours& neighbours, std::uint32_t wedge, double weight)
    {
        if (samples_.size() < kMostSamples && neighbours.is_known(wedge) &&
            std::ranges::find(samples_, wedge, &Sample::wedge) == samples_.end())
        {
            samples_.push_back({.wedge = wedge, .weight = weight});
        }
    }

    /// Neighbours first, then what lies beyond the edges across.
    void collect(const WedgeNeighbours& neighbours, std::span<const Corner> corners)
    {
        for (const Corner corner : corners)
        {
            add(neighbours, neighbours.wedge(next_corner(corner)), 1.0);
            add(neighbours, neighbours.wedge(previous_corner(corner)), 1.0);
        }
        for (const Corner corner : corners)
        {
            const std::uint32_t beyond = neighbours.beyond(corner);
            if (beyond != kNoWedge && beyond != neighbours.wedge(corner))
            {
                add(neighbours, beyond, kBeyondWeight);
            }
        }
    }

    /// Two axes of the plane in which the wedge's faces lie on the whole.
    [[nodiscard]] static std::array<Double3, 2> tangents(
        const LevelMesh& mesh, std::span<const Corner> corners
    )
    {
        Double3 normal{};
        for (const Corner corner : corners)
        {
            const auto& a = mesh.positions[mesh.vertex(corner)];
            const Double3 n = cross(
                difference(mesh.positions[mesh.vertex(next_corner(corner))], a),
                difference(mesh.positions[mesh.vertex(previous_corner(corner))], a)
            );
            normal = {normal[0] + n[0], normal[1] + n[1], normal[2] + n[2]};
        }
        const double square = dot(normal, normal);
        if (square > 0.0)
        {
            const double length = std::sqrt(square);
            normal = {normal[0] / length, normal[1] / length, normal[2] / length};
        }
        else
        {
            normal = {0.0, 0.0, 1.0};
        }
        const bool steep = normal[0] < 0.625 && normal[0] > -0.625;
        Double3 first = cross(steep ? Double3{1.0, 0.0, 0.0} : Double3{0.0, 1.0, 0.0}, normal);
        const double length = std::sqrt(dot(first, first));
        first = {first[0] / length, first[1] / length, first[2] / length};
        return {first, cross(normal, first)};
    }

    std::vector<Sample> samples_;
    double weight_ = 0.0;
    double sum_x_ = 0.0;
    double sum_y_ = 0.0;
    double mean_x_ = 0.0;
    double mean_y_ = 0.0;
    double xx_ = 0.0;
    double xy_ = 0.0;
    double yy_ = 0.0;
    double determinant_ = 1.0;
};

}  // namespace vsplit::codec
