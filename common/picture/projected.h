#pragma once

#include "mesh/indexed_mesh.h"
#include "picture/view.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::picture {

/// Steps of screen coordinates in a pixel.
constexpr std::int64_t kSubpixels = 256;

/// Where a vertex lies in a picture.
struct ScreenVertex
{
    std::int64_t x = 0;  ///< In 1 / kSubpixels pixels from the left.
    std::int64_t y = 0;  ///< From the top.
    double depth = 1.0;  ///< Along View::forward, model units.
};

/// Lays vertices on a picture of `size` pixels a side. Far outside they are moved to its vicinity, so
/// that products of coordinates fit 64 bits.
[[nodiscard]] std::vector<ScreenVertex> project(
    std::span<const std::array<double, 3>> positions, const View& view, std::uint32_t size
);

/// Shares of a triangle's corners in a point of it.
using Shares = std::array<double, 3>;

/// A triangle in a picture, turned so that it is clockwise as seen.
/// Source: Pineda, "A Parallel Algorithm for Polygon Rasterization", 1988.
class ScreenTriangle
{
public:
    /// Nothing when it is seen exactly from the side.
    [[nodiscard]] static std::optional<ScreenTriangle> make(
        std::span<const ScreenVertex> vertices, const Triangle& triangle, Projection projection
    );

    /// Calls visit(x, y) for every pixel of a picture of `size` whose centre is inside; centres on an
    /// edge belong to exactly one of the triangles that share it.
    template <typename Visit>
    void visit_pixels(std::uint32_t size, Visit&& visit) const
    {
        const auto [left, right] = std::minmax({corners_[0].x, corners_[1].x, corners_[2].x});
        const auto [top, bottom] = std::minmax({corners_[0].y, corners_[1].y, corners_[2].y});
        const std::int64_t last = std::int64_t{size} - 1;
        const std::int64_t first_x = std::max<std::int64_t>(left / kSubpixels - 1, 0);
        const std::int64_t first_y = std::max<std::int64_t>(top / kSubpixels - 1, 0);
        const std::int64_t last_x = std::min(right / kSubpixels, last);
        const std::int64_t last_y = std::min(bottom / kSubpixels, last);
        for (std::int64_t y = first_y; y <= last_y; ++y)
        {
            const std::int64_t centre = y * kSubpixels + kSubpixels / 2;
            std::array<std::int64_t, 3> value{};
            std::array<std::int64_t, 3> step{};
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::int64_t start = first_x * kSubpixels + kSubpixels / 2;
                value[k] = edge(k, start, centre) + fill_[k];
                step[k] = -(corners_[(k + 2) % 3].y - corners_[(k + 1) % 3].y) * kSubpixels;
            }
            for (std::int64_t x = first_x; x <= last_x; ++x)
            {
                if ((value[0] | value[1] | value[2]) >= 0)
                {
                    visit(x, y);
                }
                value[0] += step[0];
                value[1] += step[1];
                value[2] += step[2];
            }
        }
    }

    /// Shares of the corners, in the order of the triangle that make() was given, at a pixel's centre:
    /// perspective-correct. Pixels outside the triangle extrapolate.
    [[nodiscard]] Shares shares(std::int64_t x, std::int64_t y) const;

    /// Depth at a pixel's centre, model units.
    [[nodiscard]] double depth(std::int64_t x, std::int64_t y) const;

private:
    /// Twice the area, in subpixels, that a point spans with the edge opposite to a corner.
    [[nodiscard]] std::int64_t edge(std::size_t corner, std::int64_t x, std::int64_t y) const
    {
        const ScreenVertex& from = corners_[(corner + 1) % 3];
        const ScreenVertex& to = corners_[(corner + 2) % 3];
        return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    }

    /// Shares on the screen, each divided by its corner's depth in perspective.
    [[nodiscard]] Shares weights(std::int64_t x, std::int64_t y) const;

    std::array<ScreenVertex, 3> corners_{};
    std::array<std::int64_t, 3> fill_{};  ///< What makes edges that are not filled lose ties.
    double area_ = 1.0;                   ///< Twice the area in subpixels.
    bool turned_ = false;
    Projection projection_ = Projection::Perspective;
};

}  // namespace vsplit::picture
