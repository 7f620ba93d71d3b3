#pragma once

#include "codec/refinement_mesh.h"

#include <cmath>

namespace vsplit::codec {

/// A vector in single precision. Every operation is one IEEE operation a component, in the order
/// written, never contracted: the decoder's geometry depends on it.
struct Vector3
{
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
};

/// Componentwise sum.
[[nodiscard]] inline Vector3 operator+(const Vector3& a, const Vector3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Componentwise difference.
[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Scales every component.
[[nodiscard]] inline Vector3 operator*(const Vector3& a, float s)
{
    return {a.x * s, a.y * s, a.z * s};
}

/// Inner product: (x x + y y) + z z.
[[nodiscard]] inline float dot(const Vector3& a, const Vector3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Vector product.
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The position that a Point holds.
[[nodiscard]] inline Vector3 to_vector(const Point& point)
{
    return {point.x, point.y, point.z};
}

}  // namespace vsplit::codec
