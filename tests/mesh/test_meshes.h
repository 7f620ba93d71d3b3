#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace vsplit::test {

/// A triangle mesh in single precision, as distances take it.
struct Surface
{
    std::vector<std::array<float, 3>> positions;
    std::vector<Triangle> triangles;
};

/// A square of `size` in the plane z = `height`, cut into 2 * cells^2 triangles.
inline Surface make_plane(float size, float height, std::uint32_t cells)
{
    Surface surface;
    for (std::uint32_t y = 0; y <= cells; ++y)
    {
        for (std::uint32_t x = 0; x <= cells; ++x)
        {
            const float step = size / static_cast<float>(cells);
            surface.positions.push_back(
                {static_cast<float>(x) * step, static_cast<float>(y) * step, height}
            );
        }
    }
    const std::uint32_t row = cells + 1;
    for (std::uint32_t y = 0; y < cells; ++y)
    {
        for (std::uint32_t x = 0; x < cells; ++x)
        {
            const std::uint32_t corner = y * row + x;
            surface.triangles.push_back({corner, corner + 1, corner + row + 1});
            surface.triangles.push_back({corner, corner + row + 1, corner + row});
        }
    }
    return surface;
}

/// A sphere about the origin of `rings` times 2 * rings quadrilaterals (triangles at the poles are
/// degenerate, which distances must bear).
inline Surface make_sphere(double radius, std::uint32_t rings)
{
    Surface surface;
    const std::uint32_t around = 2 * rings;
    for (std::uint32_t ring = 0; ring <= rings; ++ring)
    {
        const double polar = std::numbers::pi * ring / rings;
        for (std::uint32_t step = 0; step < around; ++step)
        {
            const double azimuth = 2.0 * std::numbers::pi * step / around;
            surface.positions.push_back(
                {static_cast<float>(radius * std::sin(polar) * std::cos(azimuth)),
                 static_cast<float>(radius * std::sin(polar) * std::sin(azimuth)),
                 static_cast<float>(radius * std::cos(polar))}
            );
        }
    }
    for (std::uint32_t ring = 0; ring < rings; ++ring)
    {
        for (std::uint32_t step = 0; step < around; ++step)
        {
            const std::uint32_t a = ring * around + step;
            const std::uint32_t b = ring * around + (step + 1) % around;
            surface.triangles.push_back({a, a + around, b + around});
            surface.triangles.push_back({a, b + around, b});
        }
    }
    return surface;
}

}  // namespace vsplit::test
