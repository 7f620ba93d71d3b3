#pragma once

#include "codec/refinement_mesh.h"

#include <cmath>

namespace vsplit::codec {

/// A vector of `Scalar`: a float, or several in one register (mesh/lanes.h). Every operation is one IEEE
/// operation a component, in the order written, never contracted: the decoder's geometry depends on it.
template <typename Scalar>
struct BasicVector
{
    Scalar x{};
    Scalar y{};
    Scalar z{};
};

/// A vector in single precision.
using Vector3 = BasicVector<float>;

/// Componentwise sum.
template <typename Scalar>
[[nodiscard]] inline BasicVector<Scalar> operator+(
    const BasicVector<Scalar>& a, const BasicVector<Scalar>& b
)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Componentwise difference.
template <typename Scalar>
[[nodiscard]] inline BasicVector<Scalar> operator-(
    const BasicVector<Scalar>& a, const BasicVector<Scalar>& b
)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Scales every component. `s`: a Scalar, or a float for all of its lanes.
template <typename Scalar, typename Factor>
[[nodiscard]] inline BasicVector<Scalar> operator*(const BasicVector<Scalar>& a, const Factor& s)
{
    return {a.x * s, a.y * s, a.z * s};
}

/// Inner product: (x x + y y) + z z.
template <typename Scalar>
[[nodiscard]] inline Scalar dot(const BasicVector<Scalar>& a, const BasicVector<Scalar>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Vector product.
template <typename Scalar>
[[nodiscard]] inline BasicVector<Scalar> cross(
    const BasicVector<Scalar>& a, const BasicVector<Scalar>& b
)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The position that a Point holds.
[[nodiscard]] inline Vector3 to_vector(const Point& point)
{
    return {point.x, point.y, point.z};
}

}  // namespace vsplit::codec
