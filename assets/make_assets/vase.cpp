#include "make_assets/vase.h"

#include "make_assets/patch_builder.h"
#include "make_assets/vector3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace vsplit::assets {
namespace {

constexpr int kHalvings = 3;
constexpr std::uint32_t kAround = 4U << kHalvings;

constexpr std::uint32_t kClay = 0;
constexpr std::uint32_t kGlaze = 1;

/// Distance from the axis, and height.
using ProfilePoint = std::array<double, 2>;

/// Point of a Bezier curve by de Casteljau's algorithm.
ProfilePoint bezier(std::vector<ProfilePoint> points, double t)
{
    for (std::size_t n = points.size(); n > 1; --n)
    {
        for (std::size_t i = 0; i + 1 < n; ++i)
        {
            for (std::size_t k = 0; k < 2; ++k)
            {
                points[i][k] = points[i][k] + t * (points[i + 1][k] - points[i][k]);
            }
        }
    }
    return points.front();
}

/// Builds the surface ring by ring. A chart is a part with texture coordinates and normals of its own.
class VaseBuilder
{
public:
    VaseBuilder()
    {
        directions_ = circle({0, 0, 0}, {1, 0, 0}, {0, 0, -1}, 1.0, kHalvings);
        surface_.attributes.resize(3);
        SurfaceAttribute& normals = surface_.attributes[1];
        normals.kind = AttributeKind::Normal;
        normals.components = 3;
        SurfaceAttribute& colors = surface_.attributes[2];
        colors.kind = AttributeKind::Color;
        colors.components = 3;
    }

    /// Begins a chart whose triangles belong to `group`. `low`, `high`: where it lies in the image.
    void begin_chart(std::uint32_t group, double low, double high)
    {
        group_ = group;
        low_ = low;
        high_ = high;
        normals_.assign(surface_.mesh.positions.size(), {});
    }

    /// Adds a ring of vertices. Result: its first vertex.
    std::uint32_t add_ring(const ProfilePoint& at, double flutes)
    {
        const auto first = static_cast<std::uint32_t>(surface_.mesh.positions.size());
        for (const Vector3& direction : directions_)
        {
            const double c2 = 2.0 * direction.x * direction.x - 1.0;
            const double c4 = 2.0 * c2 * c2 - 1.0;
            const double c8 = 2.0 * c4 * c4 - 1.0;
            add_vertex(direction * (at[0] * (1.0 + flutes * c8)) + Vector3{0, at[1], 0}, c8);
        }
        return first;
    }

    /// Adds a vertex on the axis.
    std::uint32_t add_centre(double y)
    {
        add_vertex({0, y, 0}, 0.0);
        return static_cast<std::uint32_t>(surface_.mesh.positions.size() - 1);
    }

    /// Fills the band between two rings; `from`, `to`: 0 .. 1, its place in the chart.
    void add_band(std::uint32_t lower, std::uint32_t upper, double from, double to)
    {
        for (std::uint32_t i = 0; i < kAround; ++i)
        {
            const std::uint32_t j = (i + 1) % kAround;
            const Place a{lower + i, band_place(i, from)};
            const Place b{lower + j, band_place(i + 1, from)};
            const Place c{upper + j, band_place(i + 1, to)};
            const Place d{upper + i, band_place(i, to)};
            add_triangle(a, b, c);
            add_triangle(a, c, d);
        }
    }

    /// Closes a ring with a fan round a centre. `upwards`: which way it looks.
    void add_disc(std::uint32_t ring, std::uint32_t centre, double u, bool upwards)
    {
        const double middle = 0.5 * (low_ + high_);
        const double radius = 0.5 * (high_ - low_);
        const auto place = [&](std::uint32_t i) {
            const Vector3& direction = directions_[i % kAround];
            return Place{
                ring + i % kAround, {u + radius * direction.x, middle + radius * direction.z}};
        };
        const Place axis{centre, {u, middle}};
        for (std::uint32_t i = 0; i < kAround; ++i)
        {
            upwards ? add_triangle(place(i), place(i + 1), axis)
                    : add_triangle(place(i + 1), place(i), axis);
        }
    }

    /// Ends a chart: its normals are means over its triangles.
    void end_chart()
    {
        SurfaceAttribute& attribute = surface_.attributes[1];
        const auto& triangles = surface_.mesh.triangles;
        std::vector<std::uint32_t> number(surface_.mesh.positions.size(), 0xFFFFFFFF);
        for (std::size_t f = attribute.corners.size(); f < triangles.size(); ++f)
        {
            Triangle corners{};
            for (std::size_t k = 0; k < 3; ++k)
            {
                std::uint32_t& own = number[triangles[f][k]];
                if (own == 0xFFFFFFFF)
                {
                    own = static_cast<std::uint32_t>(attribute.size());
                    const Vector3& sum = normals_[triangles[f][k]];
                    const double size = length(sum);
                    for (const double x : {sum.x / size, sum.y / size, sum.z / size})
                    {
                        attribute.values.push_back(static_cast<float>(x));
                    }
                }
                corners[k] = own;
            }
            attribute.corners.push_back(corners);
        }
    }

    /// The surface.
    Surface take() { return std::move(surface_); }

private:
    /// A corner: a vertex and where it lies in the image.
    struct Place
    {
        std::uint32_t vertex;
        std::array<double, 2> at;
    };

    [[nodiscard]] std::array<double, 2> band_place(std::uint32_t i, double share) const
    {
        return {static_cast<double>(i) / kAround, low_ + share * (high_ - low_)};
    }

    void add_vertex(const Vector3& position, double shade)
    {
        surface_.mesh.positions.push_back({position.x, position.y, position.z});
        normals_.resize(surface_.mesh.positions.size());
        const double height = position.y / 1.2;
        for (const double x : {0.55 + 0.4 * height, 0.5 + 0.1 * shade, 0.85 - 0.5 * height})
        {
            surface_.attributes[2].values.push_back(static_cast<float>(x));
        }
    }

    void add_triangle(const Place& a, const Place& b, const Place& c)
    {
        SurfaceAttribute& coordinates = surface_.attributes[0];
        const auto first = static_cast<std::uint32_t>(coordinates.size());
        for (const Place& place : {a, b, c})
        {
            coordinates.values.push_back(static_cast<float>(place.at[0]));
            coordinates.values.push_back(static_cast<float>(place.at[1]));
        }
        coordinates.corners.push_back({first, first + 1, first + 2});
        const Triangle triangle{a.vertex, b.vertex, c.vertex};
        const auto& positions = surface_.mesh.positions;
        const Vector3 origin = to_vector(positions[a.vertex]);
        const Vector3 normal =
            cross(to_vector(positions[b.vertex]) - origin, to_vector(positions[c.vertex]) - origin);
        for (const std::uint32_t vertex : triangle)
        {
            normals_[vertex] = normals_[vertex] + normal;
        }
        surface_.mesh.triangles.push_back(triangle);
        surface_.attributes[2].corners.push_back(triangle);
        surface_.groups.push_back(group_);
    }

    Surface surface_;
    Polyline directions_;
    std::vector<Vector3> normals_;  ///< By vertex, sum over the chart's triangles.
    std::uint32_t group_ = 0;
    double low_ = 0.0;
    double high_ = 1.0;
};

/// Adds a wall along a curve, from `ring` on. Result: the last ring.
std::uint32_t add_wall(
    VaseBuilder& builder,
    std::uint32_t ring,
    const std::vector<ProfilePoint>& curve,
    std::uint32_t rows,
    double flutes
)
{
    for (std::uint32_t row = 1; row <= rows; ++row)
    {
        const double t = static_cast<double>(row) / rows;
        const double depth = 16.0 * t * t * (1.0 - t) * (1.0 - t);
        const std::uint32_t next = builder.add_ring(bezier(curve, t), flutes * depth);
        builder.add_band(ring, next, static_cast<double>(row - 1) / rows, t);
        ring = next;
    }
    return ring;
}

}  // namespace

Surface make_vase()
{
    VaseBuilder builder;
    const std::uint32_t foot = builder.add_ring({0.3, 0.0}, 0.0);
    builder.begin_chart(kClay, 0.8, 1.0);
    builder.add_disc(foot, builder.add_centre(0.0), 0.1, false);
    builder.end_chart();
    builder.begin_chart(kGlaze, 0.0, 0.6);
    const std::uint32_t rim = add_wall(
        builder, foot, {{0.3, 0.0}, {0.8, 0.25}, {0.55, 0.8}, {0.05, 0.8}, {0.26, 1.2}}, 20, 0.05
    );
    builder.end_chart();
    builder.begin_chart(kClay, 0.6, 0.62);
    const std::uint32_t inside = builder.add_ring({0.21, 1.2}, 0.0);
    builder.add_band(rim, inside, 0.0, 1.0);
    builder.end_chart();
    builder.begin_chart(kClay, 0.62, 0.8);
    const std::uint32_t bottom = add_wall(
        builder, inside, {{0.21, 1.2}, {0.02, 0.8}, {0.5, 0.8}, {0.7, 0.3}, {0.2, 0.07}}, 10, 0.0
    );
    builder.end_chart();
    builder.begin_chart(kClay, 0.8, 1.0);
    builder.add_disc(bottom, builder.add_centre(0.07), 0.3, true);
    builder.end_chart();
    return builder.take();
}

}  // namespace vsplit::assets
