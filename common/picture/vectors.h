#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace vsplit::picture {

/// A point or a direction, x y z.
using Vector = std::array<double, 3>;

/// Dot product, summed in order.
[[nodiscard]] inline double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Cross product.
[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// a - b.
[[nodiscard]] inline Vector minus(const Vector& a, const Vector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// a + s * b.
[[nodiscard]] inline Vector plus_scaled(const Vector& a, double s, const Vector& b)
{
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

/// Euclidean length.
[[nodiscard]] inline double length(const Vector& a)
{
    return std::sqrt(dot(a, a));
}

/// The vector of length 1 in the same direction; a vector of length 0 stays as it is.
[[nodiscard]] inline Vector normalized(const Vector& a)
{
    const double size = length(a);
    return size > 0.0 ? Vector{a[0] / size, a[1] / size, a[2] / size} : a;
}

}  // namespace vsplit::picture
