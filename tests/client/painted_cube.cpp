#include "painted_cube.h"

#include <array>
#include <map>

namespace vsplit::client {
namespace {

using Vector = std::array<int, 3>;

Vector cross(const Vector& a, const Vector& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The corner of a side that lies `right` and `up` of its middle.
std::uint32_t corner(const Vector& normal, const Vector& up, int right, int above)
{
    const Vector to_right = cross(up, normal);
    std::uint32_t number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const int place = normal[axis] + right * to_right[axis] + above * up[axis];
        number |= place > 0 ? 1U << axis : 0U;
    }
    return number;
}

}  // namespace

Surface cube_surface()
{
    Surface surface;
    for (std::uint32_t i = 0; i < 8; ++i)
    {
        surface.mesh.positions.push_back(
            {i & 1U ? 1.0 : -1.0, i & 2U ? 1.0 : -1.0, i & 4U ? 1.0 : -1.0}
        );
    }
    SurfaceAttribute uv;
    uv.values = {0, 0, 1, 0, 0, 1, 1, 1};  // Upper left, upper right, lower left, lower right.
    const std::array<Vector, 6> normals{
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
    for (std::uint32_t side = 0; side < 6; ++side)
    {
        const Vector& n = normals[side];
        const Vector up = n[1] != 0 ? Vector{0, 0, -1} : Vector{0, 1, 0};
        const std::array<std::uint32_t, 4> at{
            corner(n, up, -1, 1), corner(n, up, 1, 1), corner(n, up, -1, -1), corner(n, up, 1, -1)};
        surface.mesh.triangles.push_back({at[0], at[2], at[1]});
        surface.mesh.triangles.push_back({at[1], at[2], at[3]});
        uv.corners.push_back({0, 2, 1});
        uv.corners.push_back({1, 2, 3});
        surface.groups.insert(surface.groups.end(), 2, side);
    }
    surface.attributes.push_back(uv);
    return surface;
}

Raster four_fields(std::uint32_t side)
{
    const std::array<std::array<std::uint8_t, 3>, 4> colors{
        {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}};
    Raster raster{side, side, 3, {}};
    for (std::uint32_t y = 0; y < side; ++y)
    {
        for (std::uint32_t x = 0; x < side; ++x)
        {
            const auto& color = colors[2 * (y >= side / 2 ? 1 : 0) + (x >= side / 2 ? 1 : 0)];
            raster.pixels.insert(raster.pixels.end(), color.begin(), color.end());
        }
    }
    return raster;
}

Appearance cube_appearance()
{
    Appearance appearance;
    appearance.images.push_back({"fields", 256, 256, 3});
    for (std::int32_t side = 0; side < 6; ++side)
    {
        Material material;
        material.base_color_texture.image = 0;
        appearance.materials.push_back(material);
        appearance.groups.push_back({"side", side});
    }
    return appearance;
}

}  // namespace vsplit::client
