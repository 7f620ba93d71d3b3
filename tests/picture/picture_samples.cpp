#include "picture/picture_samples.h"

#include <cmath>
#include <numbers>

namespace vsplit::test {

Surface textured_square(std::uint32_t cells)
{
    Surface surface;
    SurfaceAttribute coordinates;
    for (std::uint32_t y = 0; y <= cells; ++y)
    {
        for (std::uint32_t x = 0; x <= cells; ++x)
        {
            const double u = static_cast<double>(x) / cells;
            const double v = static_cast<double>(y) / cells;
            surface.mesh.positions.push_back({2.0 * u - 1.0, 1.0 - 2.0 * v, 0.0});
            coordinates.values.push_back(static_cast<float>(u));
            coordinates.values.push_back(static_cast<float>(v));
        }
    }
    for (std::uint32_t y = 0; y < cells; ++y)
    {
        for (std::uint32_t x = 0; x < cells; ++x)
        {
            const std::uint32_t corner = y * (cells + 1) + x;
            const std::uint32_t below = corner + cells + 1;
            surface.mesh.triangles.push_back({corner, below, corner + 1});
            surface.mesh.triangles.push_back({corner + 1, below, below + 1});
        }
    }
    coordinates.corners = surface.mesh.triangles;
    surface.attributes.push_back(coordinates);
    return surface;
}

Surface cut_sphere(std::uint32_t rings, std::uint32_t sectors, double gap, double hole)
{
    Surface surface;
    const auto row = sectors + 1;  // the last vertex of a row is the copy of the first
    for (std::uint32_t r = 0; r <= rings; ++r)
    {
        const double latitude = (static_cast<double>(r) / rings - 0.5) * std::numbers::pi;
        for (std::uint32_t s = 0; s <= sectors; ++s)
        {
            const std::uint32_t place = s % sectors;
            const double angle =
                2.0 * std::numbers::pi * place / sectors + (s == sectors ? -gap : 0.0);
            const double radius = r == 0 || r == rings ? 0.0 : std::cos(latitude);
            surface.mesh.positions.push_back(
                {radius * std::cos(angle), std::sin(latitude), radius * std::sin(angle)}
            );
        }
    }
    for (std::uint32_t r = 0; r < rings; ++r)
    {
        const double top = (static_cast<double>(r + 1) / rings - 0.5) * std::numbers::pi;
        for (std::uint32_t s = 0; s < sectors && top <= hole; ++s)
        {
            const std::uint32_t corner = r * row + s;
            surface.mesh.triangles.push_back({corner, corner + row, corner + 1});
            surface.mesh.triangles.push_back({corner + 1, corner + row, corner + row + 1});
        }
    }
    return surface;
}

}  // namespace vsplit::test
