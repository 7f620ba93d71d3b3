// Based on: Pineda, "A Parallel Algorithm for Polygon Rasterization", 1988; Heckbert and Moreton,
// "Interpolation for Polygon Texture Mapping and Shading", 1991.
#include "picture/projected.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vsplit::picture {
namespace {

/// Farther outside a picture no vertex is, picture sides: edge functions stay below 2^50.
constexpr double kFarOutside = 4.0;

std::int64_t to_subpixels(double share, std::uint32_t size)
{
    const double bounded = std::clamp(share, -kFarOutside, kFarOutside);
    return static_cast<std::int64_t>(
        std::floor(bounded * size * static_cast<double>(kSubpixels) + 0.5)
    );
}

}  // namespace

std::vector<ScreenVertex> project(
    std::span<const std::array<double, 3>> positions, const View& view, std::uint32_t size
)
{
    std::vector<ScreenVertex> vertices;
    vertices.reserve(positions.size());
    for (const auto& position : positions)
    {
        const Vector arm = minus(position, view.eye);
        const double depth = std::max(dot(arm, view.forward), view.nearest);
        const double scale = view.shown_length(1.0, depth);
        vertices.push_back(
            {to_subpixels(0.5 + dot(arm, view.right) * scale, size),
             to_subpixels(0.5 - dot(arm, view.up) * scale, size),
             depth}
        );
    }
    return vertices;
}

std::optional<ScreenTriangle> ScreenTriangle::make(
    std::span<const ScreenVertex> vertices, const Triangle& triangle, Projection projection
)
{
    ScreenTriangle result;
    result.projection_ = projection;
    for (std::size_t k = 0; k < 3; ++k)
    {
        result.corners_[k] = vertices[triangle[k]];
    }
    std::int64_t area = result.edge(0, result.corners_[0].x, result.corners_[0].y);
    if (area == 0)
    {
        return std::nullopt;
    }
    if (area < 0)
    {
        std::swap(result.corners_[1], result.corners_[2]);
        result.turned_ = true;
        area = -area;
    }
    result.area_ = static_cast<double>(area);
    for (std::size_t k = 0; k < 3; ++k)
    {
        // Clockwise as seen, upper edges go right and left edges go up.
        const std::int64_t right = result.corners_[(k + 2) % 3].x - result.corners_[(k + 1) % 3].x;
        const std::int64_t down = result.corners_[(k + 2) % 3].y - result.corners_[(k + 1) % 3].y;
        result.fill_[k] = down < 0 || (down == 0 && right > 0) ? 0 : -1;
    }
    return result;
}

Shares ScreenTriangle::weights(std::int64_t x, std::int64_t y) const
{
    const std::int64_t centre_x = x * kSubpixels + kSubpixels / 2;
    const std::int64_t centre_y = y * kSubpixels + kSubpixels / 2;
    Shares result{};
    for (std::size_t k = 0; k < 3; ++k)
    {
        result[k] = static_cast<double>(edge(k, centre_x, centre_y)) / area_;
        if (projection_ == Projection::Perspective)
        {
            result[k] /= corners_[k].depth;  // Heckbert and Moreton, section 2
        }
    }
    return result;
}

Shares ScreenTriangle::shares(std::int64_t x, std::int64_t y) const
{
    Shares result = weights(x, y);
    const double sum = result[0] + result[1] + result[2];
    for (double& share : result)
    {
        share /= sum;
    }
    if (turned_)
    {
        std::swap(result[1], result[2]);
    }
    return result;
}

double ScreenTriangle::depth(std::int64_t x, std::int64_t y) const
{
    const Shares share = weights(x, y);
    if (projection_ == Projection::Perspective)
    {
        return 1.0 / (share[0] + share[1] + share[2]);
    }
    return share[0] * corners_[0].depth + share[1] * corners_[1].depth +
           share[2] * corners_[2].depth;
}

}  // namespace vsplit::picture
