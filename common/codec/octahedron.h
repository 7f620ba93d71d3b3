#pragma once

// Based on: Meyer, Suessmuth, Sussner, Stamminger, Greiner, "On Floating-Point Normal Vectors", 2010
// (octahedral coordinates). Directions are three integers whose magnitudes add up to `half`; because that
// set does not change when axes are exchanged, any axis can be the one that is left out.

#include "codec/value_fit.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace vsplit::codec {

/// A direction: |x| + |y| + |z| = half.
using OctaPoint = std::array<std::int32_t, 3>;

/// Two coordinates on the octahedron's unfolded surface, each in -half .. half.
using OctaCoordinates = std::array<std::int32_t, 2>;

/// The side of the octahedron that a direction lies nearest to: an axis and a sign.
struct OctaSide
{
    std::size_t axis = 2;
    std::int32_t sign = 1;
};

/// Rounds a direction. `direction`: any length; zero stands for (0, 0, 1).
[[nodiscard]] inline OctaPoint octa_point(const Double3& direction, std::int32_t half)
{
    const double sum = std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]);
    if (!(sum > 0.0))
    {
        return {0, 0, half};
    }
    const double scale = static_cast<double>(half) / sum;
    OctaPoint point{
        static_cast<std::int32_t>(std::floor(direction[0] * scale + 0.5)),
        static_cast<std::int32_t>(std::floor(direction[1] * scale + 0.5)),
        0};
    std::int32_t rest = half - std::abs(point[0]) - std::abs(point[1]);
    // Both may have been rounded up.
    if (rest < 0)
    {
        point[0] -= point[0] < 0 ? -1 : 1;
        ++rest;
    }
    point[2] = direction[2] < 0.0 ? -rest : rest;
    return point;
}

/// The side that a direction lies nearest to.
[[nodiscard]] inline OctaSide nearest_side(const OctaPoint& point)
{
    std::size_t axis = 2;
    axis = std::abs(point[1]) > std::abs(point[axis]) ? 1 : axis;
    axis = std::abs(point[0]) > std::abs(point[axis]) ? 0 : axis;
    return {axis, point[axis] < 0 ? -1 : 1};
}

/// Unfolds the octahedron so that `side` lies in the middle.
[[nodiscard]] inline OctaCoordinates unfold(
    const OctaPoint& point, const OctaSide& side, std::int32_t half
)
{
    const std::int32_t u = point[(side.axis + 1) % 3];
    const std::int32_t v = point[(side.axis + 2) % 3];
    if (side.sign * point[side.axis] >= 0)
    {
        return {u, v};
    }
    return {
        u < 0 ? std::abs(v) - half : half - std::abs(v),
        v < 0 ? std::abs(u) - half : half - std::abs(u)};
}

/// Folds it up again. Precondition: both coordinates lie in -half .. half.
[[nodiscard]] inline OctaPoint fold(
    const OctaCoordinates& at, const OctaSide& side, std::int32_t half
)
{
    const std::int32_t rest = half - std::abs(at[0]) - std::abs(at[1]);
    OctaPoint point{};
    std::int32_t& u = point[(side.axis + 1) % 3];
    std::int32_t& v = point[(side.axis + 2) % 3];
    u = at[0];
    v = at[1];
    if (rest < 0)
    {
        u = at[0] < 0 ? std::abs(at[1]) - half : half - std::abs(at[1]);
        v = at[1] < 0 ? std::abs(at[0]) - half : half - std::abs(at[0]);
    }
    point[side.axis] = side.sign * rest;
    return point;
}

}  // namespace vsplit::codec
