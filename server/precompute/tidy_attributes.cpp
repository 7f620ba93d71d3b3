#include "precompute/source_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace vsplit::precompute {
namespace {

using Direction = std::array<double, 3>;

/// The unit normal of a triangle; zero when it has no area.
Direction face_normal(const IndexedMesh& mesh, const Triangle& triangle)
{
    const auto& a = mesh.positions[triangle[0]];
    const auto& b = mesh.positions[triangle[1]];
    const auto& c = mesh.positions[triangle[2]];
    const Direction u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Direction v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    Direction normal{
        u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length =
        std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (double& component : normal)
    {
        component = length > 0.0 && std::isfinite(length) ? component / length : 0.0;
    }
    return normal;
}

bool is_zero(const Direction& direction)
{
    return direction == Direction{};
}

Direction normal_at(const SurfaceAttribute& normals, std::size_t value)
{
    const float* const first = normals.values.data() + 3 * value;
    return {first[0], first[1], first[2]};
}

void set_normal(SurfaceAttribute& normals, std::size_t value, const Direction& direction)
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        normals.values[3 * value + i] = static_cast<float>(direction[i]);
    }
}

std::string word_for(const SurfaceAttribute& attribute)
{
    switch (attribute.kind)
    {
        case AttributeKind::TexCoord:
            return "texture coordinates";
        case AttributeKind::Normal:
            return "normals";
        case AttributeKind::Color:
            return "colours";
        case AttributeKind::Scalar:
            break;
    }
    return "values of '" + attribute.name + "'";
}

void zero_what_is_not_finite(SurfaceAttribute& attribute, DroppedNotes& dropped)
{
    std::size_t bad = 0;
    for (float& value : attribute.values)
    {
        bad += std::isfinite(value) ? 0 : 1;
        value = std::isfinite(value) ? value : 0.0F;
    }
    if (bad > 0)
    {
        dropped.add(
            std::to_string(bad) + " numbers among the " + word_for(attribute) +
            " that are not finite (now 0)"
        );
    }
}

/// Makes the lengths 1; leaves exact ones alone, so that reading what was written changes nothing.
void normalise(SurfaceAttribute& normals)
{
    constexpr double kExact = 1e-6;
    for (std::size_t value = 0; value < normals.size(); ++value)
    {
        Direction direction = normal_at(normals, value);
        const double length = std::hypot(direction[0], direction[1], direction[2]);
        if (length > 0.0 && std::abs(length - 1.0) > kExact)
        {
            for (double& component : direction)
            {
                component /= length;
            }
            set_normal(normals, value, direction);
        }
    }
}

/// Gives the corners whose normal has no direction that of their face.
void fill_missing_normals(SurfaceAttribute& normals, const IndexedMesh& mesh)
{
    const std::size_t known = normals.size();
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
    {
        std::optional<std::uint32_t> filler;
        for (std::uint32_t& value : normals.corners[face])
        {
            if (!is_zero(normal_at(normals, value)))
            {
                continue;
            }
            if (!filler)
            {
                filler = static_cast<std::uint32_t>(normals.size());
                normals.values.resize(normals.values.size() + 3);
                const Direction normal = face_normal(mesh, mesh.triangles[face]);
                set_normal(normals, *filler, is_zero(normal) ? Direction{0.0, 0.0, 1.0} : normal);
            }
            value = *filler;
        }
    }
    for (std::size_t value = 0; value < known; ++value)
    {
        if (is_zero(normal_at(normals, value)))
        {
            set_normal(normals, value, {0.0, 0.0, 1.0});  // no corner has it any more
        }
    }
}

/// True when every corner's normal is that of its face.
bool is_flat(const SurfaceAttribute& normals, const IndexedMesh& mesh)
{
    constexpr double kSame = 0.9995;  // normals are often stored with eight bits
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
    {
        const Direction wanted = face_normal(mesh, mesh.triangles[face]);
        for (const std::uint32_t value : normals.corners[face])
        {
            const Direction given = normal_at(normals, value);
            const double cosine =
                wanted[0] * given[0] + wanted[1] * given[1] + wanted[2] * given[2];
            if (!is_zero(wanted) && cosine < kSame)
            {
                return false;
            }
        }
    }
    return true;
}

void tidy_colors(SurfaceAttribute& colors)
{
    for (float& value : colors.values)
    {
        value = std::clamp(value, 0.0F, 1.0F);
    }
    if (colors.components != 4)
    {
        return;
    }
    std::size_t opaque = 0;
    for (std::size_t i = 3; i < colors.values.size(); i += 4)
    {
        opaque += colors.values[i] == 1.0F ? 1 : 0;
    }
    if (opaque < colors.size())
    {
        return;
    }
    for (std::size_t i = 0; i < opaque; ++i)
    {
        std::copy_n(colors.values.begin() + 4 * i, 3, colors.values.begin() + 3 * i);
    }
    colors.components = 3;
    colors.values.resize(3 * opaque);
}

}  // namespace

void DroppedNotes::add(std::string note)
{
    constexpr std::size_t kMost = 50;
    if (notes_.size() > kMost || std::find(notes_.begin(), notes_.end(), note) != notes_.end())
    {
        return;
    }
    notes_.push_back(notes_.size() < kMost ? std::move(note) : "and more");
}

void tidy_attributes(Surface& surface, DroppedNotes& dropped)
{
    for (SurfaceAttribute& attribute : surface.attributes)
    {
        zero_what_is_not_finite(attribute, dropped);
        if (attribute.kind == AttributeKind::Color)
        {
            tidy_colors(attribute);
        }
        if (attribute.kind == AttributeKind::Normal)
        {
            normalise(attribute);
            fill_missing_normals(attribute, surface.mesh);
        }
    }
    const auto says_nothing = [&](const SurfaceAttribute& attribute) {
        return attribute.kind == AttributeKind::Normal && is_flat(attribute, surface.mesh);
    };
    if (std::erase_if(surface.attributes, says_nothing) > 0)
    {
        dropped.add("normals that are those of the flat faces (derived again for drawing)");
    }
}

}  // namespace vsplit::precompute
