#include "picture/view.h"

#include "core/assert.h"

#include <algorithm>
#include <array>

namespace vsplit::picture {
namespace {

constexpr double kDistance = 3.0;  // radii from the eye to the centre
constexpr double kShare = 0.95;    // of the picture that the sphere fills

constexpr std::array<Vector, kCornerViews> kCorners{
    {{1.0, 1.0, 1.0},
     {-1.0, -1.0, -1.0},
     {1.0, -1.0, -1.0},
     {-1.0, 1.0, 1.0},
     {-1.0, 1.0, -1.0},
     {1.0, -1.0, 1.0},
     {-1.0, -1.0, 1.0},
     {1.0, 1.0, -1.0}}};

/// Centre of the bounding box.
Vector centre_of(std::span<const Vector> positions)
{
    Vector low = positions.front();
    Vector high = low;
    for (const Vector& position : positions)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            low[k] = std::min(low[k], position[k]);
            high[k] = std::max(high[k], position[k]);
        }
    }
    return {(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0};
}

double radius_around(const Vector& centre, std::span<const Vector> positions)
{
    double most = 0.0;
    for (const Vector& position : positions)
    {
        const Vector arm = minus(position, centre);
        most = std::max(most, dot(arm, arm));
    }
    return most > 0.0 ? std::sqrt(most) : 1.0;
}

}  // namespace

std::vector<View> corner_views(
    std::span<const std::array<double, 3>> positions, std::size_t count, Projection projection
)
{
    VSPLIT_ASSERT(!positions.empty() && count <= kCornerViews);
    const Vector centre = centre_of(positions);
    const double radius = radius_around(centre, positions);
    std::vector<View> views;
    for (std::size_t i = 0; i < count; ++i)
    {
        View view;
        const Vector outward = normalized(kCorners[i]);
        view.projection = projection;
        view.eye = plus_scaled(centre, kDistance * radius, outward);
        view.forward = {-outward[0], -outward[1], -outward[2]};
        view.right = normalized(cross(view.forward, {0.0, 1.0, 0.0}));
        view.up = cross(view.right, view.forward);
        // The sphere's outline is seen under an angle whose tangent is 1 / sqrt(kDistance^2 - 1).
        view.zoom = projection == Projection::Perspective
                        ? kShare / 2.0 * std::sqrt(kDistance * kDistance - 1.0)
                        : kShare / 2.0 / radius;
        view.nearest = radius / 8.0;
        views.push_back(view);
    }
    return views;
}

}  // namespace vsplit::picture
