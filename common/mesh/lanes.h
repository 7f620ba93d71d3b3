#pragma once

#include <array>
#include <cstddef>
#include <cstring>

/// Four floats that are computed on at once. GCC's and Clang's vector extension gives SSE, NEON or
/// WebAssembly SIMD from one source, with the same IEEE results as scalar code.
namespace vsplit::lanes {

/// Floats in one register.
inline constexpr std::size_t kLanes = 4;

/// Four floats in one register.
using Float4 = float __attribute__((vector_size(16)));

/// Loads four floats.
[[nodiscard]] inline Float4 load(const std::array<float, 4>& values)
{
    Float4 result;
    std::memcpy(&result, values.data(), sizeof(result));
    return result;
}

/// Stores four floats.
[[nodiscard]] inline std::array<float, 4> store(Float4 values)
{
    std::array<float, 4> result;
    std::memcpy(result.data(), &values, sizeof(values));
    return result;
}

/// Returns four times the same value.
[[nodiscard]] inline Float4 splat(float value)
{
    return Float4{value, value, value, value};
}

/// Returns the smaller one, lane by lane.
[[nodiscard]] inline Float4 min(Float4 a, Float4 b)
{
    return a < b ? a : b;
}

/// Returns the larger one, lane by lane.
[[nodiscard]] inline Float4 max(Float4 a, Float4 b)
{
    return a > b ? a : b;
}

/// Limits each lane to 0 .. 1.
[[nodiscard]] inline Float4 clamp01(Float4 value)
{
    return min(max(value, splat(0)), splat(1));
}

/// Three coordinates of four points or vectors.
struct Vector4
{
    Float4 x;
    Float4 y;
    Float4 z;
};

/// Loads four vectors stored as x, y and z lanes.
[[nodiscard]] inline Vector4 load(const std::array<std::array<float, 4>, 3>& values)
{
    return {load(values[0]), load(values[1]), load(values[2])};
}

/// Loads four vectors from lists of x, y and z, `first` onwards.
template <std::size_t N>
[[nodiscard]] inline Vector4 load(
    const std::array<std::array<float, N>, 3>& values, std::size_t first
)
{
    Vector4 result;
    std::memcpy(&result.x, values[0].data() + first, sizeof(Float4));
    std::memcpy(&result.y, values[1].data() + first, sizeof(Float4));
    std::memcpy(&result.z, values[2].data() + first, sizeof(Float4));
    return result;
}

/// Returns four times the same point.
[[nodiscard]] inline Vector4 splat(const std::array<float, 3>& point)
{
    return {splat(point[0]), splat(point[1]), splat(point[2])};
}

/// Returns a - b, lane by lane.
[[nodiscard]] inline Vector4 operator-(const Vector4& a, const Vector4& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Returns the scalar products of four pairs of vectors.
[[nodiscard]] inline Float4 dot(const Vector4& a, const Vector4& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Returns the squared lengths of a - factor * b, lane by lane.
[[nodiscard]] inline Float4 squared_length(const Vector4& a, Float4 factor, const Vector4& b)
{
    const Vector4 rest{a.x - factor * b.x, a.y - factor * b.y, a.z - factor * b.z};
    return dot(rest, rest);
}

}  // namespace vsplit::lanes
