#pragma once

#include "mesh/indexed_mesh.h"
#include "picture/vectors.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::picture {

/// How space is laid on a picture.
enum class Projection : std::uint8_t
{
    Perspective,
    Orthographic,
};

/// A camera: where it stands, its axes (of length 1, at right angles), and how large it shows things.
struct View
{
    Projection projection = Projection::Perspective;
    Vector eye{};                    ///< Model units.
    Vector right{1.0, 0.0, 0.0};     ///< Towards the picture's right side.
    Vector up{0.0, 1.0, 0.0};        ///< Towards its upper side.
    Vector forward{0.0, 0.0, -1.0};  ///< Into it.
    /// Picture sides that one unit fills: perspective one unit beside for each unit ahead, orthographic
    /// one model unit.
    double zoom = 1.0;
    double nearest = 1e-3;  ///< What is nearer, model units, is drawn as if it was so far; > 0.

    /// Picture sides that a length across the view fills at a depth, both model units.
    [[nodiscard]] double shown_length(double size, double depth) const
    {
        return projection == Projection::Perspective ? size * zoom / depth : size * zoom;
    }
};

/// Most views that corner_views() makes.
constexpr std::size_t kCornerViews = 8;

/// Looks at a model from the corners of a cube around it, from opposite ones first, so that the first
/// two see all sides and the first four are well spread.
/// `positions`: of the original, model units, at least one; every level must be drawn with the
/// original's views. `count`: 1 .. kCornerViews. Result: the sphere around the model fills 95 % of
/// each picture, seen from three radii away. Cost: linear. Thread safe.
[[nodiscard]] std::vector<View> corner_views(
    std::span<const std::array<double, 3>> positions,
    std::size_t count = kCornerViews,
    Projection projection = Projection::Perspective
);

}  // namespace vsplit::picture
