#pragma once

#include "paper/vectors.h"

#include <algorithm>
#include <array>

namespace vsplit::bench {

/// The point of a triangle that is closest to another point.
struct Projection
{
    double squared_distance = 0.0;
    std::array<double, 3> weights{};  ///< Of the three corners; they sum to 1.
};

/// Finds the closest point of a segment a b, as weights of both.
[[nodiscard]] inline Projection project_on_segment(
    const Vector3& point, const std::array<Vector3, 3>& corners, std::size_t a, std::size_t b
)
{
    const Vector3 edge = corners[b] - corners[a];
    const double square = dot(edge, edge);
    const double t =
        square > 0.0 ? std::clamp(dot(point - corners[a], edge) / square, 0.0, 1.0) : 0.0;
    const Vector3 off = point - (corners[a] + edge * t);
    Projection result{dot(off, off), {}};
    result.weights[a] = 1.0 - t;
    result.weights[b] = t;
    return result;
}

/// Finds the closest point of a triangle.
[[nodiscard]] inline Projection project(const Vector3& point, const std::array<Vector3, 3>& corners)
{
    const auto& [a, b, c] = corners;
    const Vector3 normal = cross(b - a, c - a);
    const double square = dot(normal, normal);
    if (square > 0.0)
    {
        const double u = dot(cross(c - b, point - b), normal) / square;
        const double v = dot(cross(a - c, point - c), normal) / square;
        const double w = 1.0 - u - v;
        if (u >= 0.0 && v >= 0.0 && w >= 0.0)
        {
            const double height = dot(point - a, normal);
            return {height * height / square, {u, v, w}};
        }
    }
    return std::min(
        {project_on_segment(point, corners, 0, 1),
         project_on_segment(point, corners, 1, 2),
         project_on_segment(point, corners, 2, 0)},
        [](const Projection& x, const Projection& y) {
            return x.squared_distance < y.squared_distance;
        }
    );
}

}  // namespace vsplit::bench
