#include "precompute/tex_coord_bits.h"

#include <algorithm>
#include <cstddef>

namespace vsplit::precompute {
namespace {

/// Cells of the grid in a texel: rounding is off by half a cell.
constexpr double kCellsPerTexel = 3.0;

/// The longest way that a set of texture coordinates goes in one component.
double extent_of(const SurfaceAttribute& attribute)
{
    double extent = 0.0;
    for (std::size_t k = 0; k < attribute.components; ++k)
    {
        double low = attribute.values.empty() ? 0.0 : static_cast<double>(attribute.values[k]);
        double high = low;
        for (std::size_t i = k; i < attribute.values.size(); i += attribute.components)
        {
            const auto value = static_cast<double>(attribute.values[i]);
            low = std::min(low, value);
            high = std::max(high, value);
        }
        extent = std::max(extent, high - low);
    }
    return extent;
}

/// Texels along the longest side of the largest image that a set of texture coordinates places.
std::uint32_t texels_of(const Appearance& appearance, std::uint8_t set, std::uint32_t max_size)
{
    std::uint32_t texels = 0;
    for (const Material& material : appearance.materials)
    {
        for (const TextureUse* use :
             {&material.base_color_texture,
              &material.metallic_roughness_texture,
              &material.normal_texture,
              &material.occlusion_texture,
              &material.emissive_texture})
        {
            if (use->tex_coord_set == set && use->image >= 0 &&
                static_cast<std::size_t>(use->image) < appearance.images.size())
            {
                const ImageInfo& image = appearance.images[static_cast<std::size_t>(use->image)];
                texels = std::max({texels, image.width, image.height});
            }
        }
    }
    return std::min(texels, max_size);
}

}  // namespace

std::uint8_t choose_tex_coord_bits(
    std::span<const SurfaceAttribute> attributes,
    const Appearance& appearance,
    std::uint32_t max_size
)
{
    std::uint8_t bits = kPlainTexCoordBits;
    for (const SurfaceAttribute& attribute : attributes)
    {
        if (attribute.kind != AttributeKind::TexCoord)
        {
            continue;
        }
        const std::uint32_t texels = texels_of(appearance, attribute.set, max_size);
        if (texels > 0)
        {
            bits = std::max(bits, kLeastTexCoordBits);
        }
        const double cells = kCellsPerTexel * texels * extent_of(attribute);
        while (bits < kMostTexCoordBits && static_cast<double>((1 << bits) - 1) < cells)
        {
            ++bits;
        }
    }
    return bits;
}

}  // namespace vsplit::precompute
