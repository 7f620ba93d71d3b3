#pragma once

#include <array>
#include <cmath>

namespace vsplit::assets {

/// A point or direction. Only + - * / and square roots are used on it, which IEEE 754 rounds alike
/// everywhere: the models do not depend on the machine that makes them.
struct Vector3
{
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;

    /// Sum.
    friend Vector3 operator+(const Vector3& a, const Vector3& b)
    {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }

    /// Difference.
    friend Vector3 operator-(const Vector3& a, const Vector3& b)
    {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }

    /// Multiple.
    friend Vector3 operator*(const Vector3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

/// Scalar product.
[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Vector product.
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Length.
[[nodiscard]] inline double length(const Vector3& a)
{
    return std::sqrt(dot(a, a));
}

/// `a` at length 1; zero stays zero.
[[nodiscard]] inline Vector3 unit(const Vector3& a)
{
    const double norm = length(a);
    return norm > 0.0 ? a * (1.0 / norm) : a;
}

/// From the mesh's position type.
[[nodiscard]] inline Vector3 to_vector(const std::array<double, 3>& p)
{
    return {p[0], p[1], p[2]};
}

/// To the mesh's position type.
[[nodiscard]] inline std::array<double, 3> to_array(const Vector3& p)
{
    return {p.x, p.y, p.z};
}

}  // namespace vsplit::assets
