// Based on: Gouraud, "Continuous Shading of Curved Surfaces", 1971 (derived normals); Phong,
// "Illumination for Computer Generated Pictures", 1975 (normals interpolated in a triangle).
#include "picture/surface_shader.h"

#include <algorithm>
#include <cmath>

namespace vsplit::picture {
namespace {

/// What a surface without materials looks like.
constexpr double kPlain = 204.0;
constexpr double kAmbient = 0.25;
constexpr double kDiffuse = 0.75;
/// Where the sum of the area vectors around a vertex is so long, as a share of the area, the smooth
/// normal begins to count, and counts alone.
constexpr double kRough = 0.90;
constexpr double kFlat = 0.985;

/// Interpolates the values at a triangle's corners.
std::array<double, 4> interpolate(
    const SurfaceAttribute& attribute, std::uint32_t triangle, const Shares& shares
)
{
    std::array<double, 4> result{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
        const std::size_t first =
            std::size_t{attribute.corners[triangle][corner]} * attribute.components;
        for (std::size_t k = 0; k < attribute.components; ++k)
        {
            result[k] += shares[corner] * static_cast<double>(attribute.values[first + k]);
        }
    }
    return result;
}

/// Twice a triangle's area, along its normal.
Vector area_vector(const IndexedMesh& mesh, const Triangle& triangle)
{
    const Vector& origin = mesh.positions[triangle[0]];
    return cross(
        minus(mesh.positions[triangle[1]], origin), minus(mesh.positions[triangle[2]], origin)
    );
}

double smooth_step(double low, double high, double value)
{
    const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// Nearly what displays make of a linear factor: 2.0 instead of 2.2 needs only a square root.
double encode_factor(float linear)
{
    return std::sqrt(std::clamp(static_cast<double>(linear), 0.0, 1.0));
}

}  // namespace

SurfaceShader::SurfaceShader(const Scene& scene, const View& view)
    : surface_(*scene.surface), scene_(scene)
{
    to_viewer_ = {-view.forward[0], -view.forward[1], -view.forward[2]};
    to_light_ = normalized(plus_scaled(plus_scaled(to_viewer_, 0.6, view.up), -0.4, view.right));
    for (const SurfaceAttribute& attribute : surface_.attributes)
    {
        if (attribute.values.empty() || attribute.corners.empty())
        {
            continue;
        }
        if (attribute.kind == AttributeKind::TexCoord)
        {
            coordinates_[attribute.set] = &attribute;
        }
        else if (attribute.set == 0 && attribute.kind == AttributeKind::Normal)
        {
            normals_ = &attribute;
        }
        else if (attribute.set == 0 && attribute.kind == AttributeKind::Color)
        {
            colors_ = &attribute;
        }
    }
    if (normals_ == nullptr)
    {
        derive_normals();
    }
}

void SurfaceShader::derive_normals()
{
    derived_.resize(surface_.mesh.positions.size());
    for (const Triangle& triangle : surface_.mesh.triangles)
    {
        const Vector area = area_vector(surface_.mesh, triangle);
        const double size = length(area);
        for (const std::uint32_t vertex : triangle)
        {
            VertexSum& sum = derived_[vertex];
            sum.areas = plus_scaled(sum.areas, 1.0, area);
            sum.area += size;
        }
    }
}

const Material* SurfaceShader::material(std::uint32_t triangle) const
{
    const Appearance* const appearance = scene_.appearance;
    if (appearance == nullptr || appearance->materials.empty())
    {
        return nullptr;
    }
    const std::uint32_t group = surface_.groups.empty() ? 0 : surface_.groups[triangle];
    if (group >= appearance->groups.size() || appearance->groups[group].material < 0)
    {
        return nullptr;
    }
    return &appearance->materials[static_cast<std::size_t>(appearance->groups[group].material)];
}

bool SurfaceShader::has_mask(std::uint32_t triangle) const
{
    const Material* const found = material(triangle);
    return found != nullptr && found->alpha_mode != AlphaMode::Opaque;
}

bool SurfaceShader::is_seen(
    std::uint32_t triangle, const ScreenTriangle& screen, std::int64_t x, std::int64_t y
) const
{
    const Material* const found = material(triangle);
    const double cutoff = found->alpha_mode == AlphaMode::Mask ? found->alpha_cutoff : 0.5;
    return base_color(triangle, screen, x, y)[3] >= cutoff * 255.0;
}

Rgba SurfaceShader::base_color(
    std::uint32_t triangle, const ScreenTriangle& screen, std::int64_t x, std::int64_t y
) const
{
    const Material* const found = material(triangle);
    const Shares shares = screen.shares(x, y);
    Rgba color{kPlain, kPlain, kPlain, 255.0};
    if (found != nullptr || colors_ != nullptr)
    {
        color = {255.0, 255.0, 255.0, 255.0};
    }
    for (std::size_t k = 0; found != nullptr && k < 4; ++k)
    {
        color[k] *= k < 3 ? encode_factor(found->base_color[k]) : double{found->base_color[3]};
    }
    if (colors_ != nullptr)
    {
        const auto value = interpolate(*colors_, triangle, shares);
        for (std::size_t k = 0; k < colors_->components; ++k)
        {
            color[k] *= std::clamp(value[k], 0.0, 1.0);
        }
    }
    const TextureUse use = found != nullptr ? found->base_color_texture : TextureUse{};
    const SurfaceAttribute* const coordinates = coordinates_[use.tex_coord_set];
    if (use.image < 0 || static_cast<std::size_t>(use.image) >= scene_.textures.size() ||
        coordinates == nullptr || scene_.textures[static_cast<std::size_t>(use.image)].empty())
    {
        return color;
    }
    const Texture& texture = scene_.textures[static_cast<std::size_t>(use.image)];
    const auto here = interpolate(*coordinates, triangle, shares);
    double footprint = 0.0;
    for (const auto& next : {screen.shares(x + 1, y), screen.shares(x, y + 1)})
    {
        const auto there = interpolate(*coordinates, triangle, next);
        const double across = (there[0] - here[0]) * texture.width();
        const double down = (there[1] - here[1]) * texture.height();
        footprint = std::max(footprint, across * across + down * down);
    }
    const Rgba texel = texture.sample(here[0], here[1], use, footprint);
    for (std::size_t k = 0; k < 4; ++k)
    {
        color[k] *= texel[k] / 255.0;
    }
    return color;
}

Vector SurfaceShader::derived_normal(std::uint32_t triangle, const Shares& shares) const
{
    const Triangle& corners = surface_.mesh.triangles[triangle];
    const Vector plane = normalized(area_vector(surface_.mesh, corners));
    Vector smooth{};
    double flatness = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const VertexSum& sum = derived_[corners[k]];
        const double size = length(sum.areas);
        smooth = plus_scaled(smooth, shares[k], normalized(sum.areas));
        flatness += sum.area > 0.0 ? shares[k] * size / sum.area : 0.0;
    }
    const double share = smooth_step(kRough, kFlat, flatness);
    Vector mixed{};
    mixed = plus_scaled(mixed, 1.0 - share, plane);
    return plus_scaled(mixed, share, normalized(smooth));
}

Vector SurfaceShader::normal(std::uint32_t triangle, const Shares& shares) const
{
    if (normals_ == nullptr)
    {
        return normalized(derived_normal(triangle, shares));
    }
    const auto value = interpolate(*normals_, triangle, shares);
    return normalized({value[0], value[1], value[2]});
}

std::array<std::uint8_t, 3> SurfaceShader::color(
    std::uint32_t triangle, const ScreenTriangle& screen, std::int64_t x, std::int64_t y
) const
{
    const Rgba base = base_color(triangle, screen, x, y);
    const Vector direction = normal(triangle, screen.shares(x, y));
    // Both sides of a triangle are lit alike, however it is oriented.
    const double side = dot(direction, to_viewer_) < 0.0 ? -1.0 : 1.0;
    const double light = kAmbient + kDiffuse * std::max(side * dot(direction, to_light_), 0.0);
    std::array<std::uint8_t, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
    {
        const double value = std::clamp(base[k] * light, 0.0, 255.0);
        result[k] = static_cast<std::uint8_t>(std::floor(value + 0.5));
    }
    return result;
}

}  // namespace vsplit::picture
