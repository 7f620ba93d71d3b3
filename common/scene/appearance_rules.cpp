#include "scene/appearance_rules.h"

#include <flatbuffers/util.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vsplit::scene {

namespace {

constexpr float kMaxEmissive = 65504.0F;  // what a half-float texture holds
constexpr float kMaxNormalScale = 1024.0F;

bool in_range(float value, float low, float high)
{
    return value >= low && value <= high;  // false for what is not a number
}

float clamp(float value, float low, float high, float otherwise)
{
    return std::isnan(value) ? otherwise : std::clamp(value, low, high);
}

std::array<const TextureUse*, 5> textures(const Material& material)
{
    return {
        &material.base_color_texture,
        &material.metallic_roughness_texture,
        &material.normal_texture,
        &material.occlusion_texture,
        &material.emissive_texture,
    };
}

/// Bytes of the printable character that begins at `text`, 0 when there is none.
std::size_t character_bytes(const char* text)
{
    const char* end = text;
    const int code = flatbuffers::FromUTF8(&end);
    const bool is_control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    return is_control ? 0 : static_cast<std::size_t>(end - text);
}

}  // namespace

bool is_valid(const TextureUse& use, std::size_t images)
{
    return use.image >= 0 && static_cast<std::size_t>(use.image) < images &&
           use.tex_coord_set <= kMaxTexCoordSet && use.wrap_u <= TextureWrap::Clamp &&
           use.wrap_v <= TextureWrap::Clamp;
}

bool is_valid(const Material& material, std::size_t images)
{
    const auto is_factor = [](float value) { return in_range(value, 0.0F, 1.0F); };
    const auto is_light = [](float value) { return in_range(value, 0.0F, kMaxEmissive); };
    const auto uses = textures(material);
    return std::all_of(material.base_color.begin(), material.base_color.end(), is_factor) &&
           is_factor(material.metallic) && is_factor(material.roughness) &&
           std::all_of(material.emissive.begin(), material.emissive.end(), is_light) &&
           in_range(material.normal_scale, -kMaxNormalScale, kMaxNormalScale) &&
           is_factor(material.occlusion_strength) && material.alpha_mode <= AlphaMode::Blend &&
           is_light(material.alpha_cutoff) &&
           std::all_of(uses.begin(), uses.end(), [&](const TextureUse* use) {
               return *use == TextureUse{} || is_valid(*use, images);
           });
}

bool is_valid(const ImageInfo& image, const AppearanceLimits& limits)
{
    return image.width >= 1 && image.width <= limits.max_image_side && image.height >= 1 &&
           image.height <= limits.max_image_side && image.channels >= 1 && image.channels <= 4;
}

bool is_valid_name(const std::string& name, std::size_t max_bytes)
{
    if (name.size() > max_bytes)
    {
        return false;
    }
    std::size_t at = 0;
    while (at < name.size())
    {
        const std::size_t bytes = character_bytes(name.c_str() + at);
        if (bytes == 0)
        {
            return false;
        }
        at += bytes;
    }
    return true;
}

Material clamped(Material material)
{
    for (float& value : material.base_color)
    {
        value = clamp(value, 0.0F, 1.0F, 1.0F);
    }
    for (float& value : material.emissive)
    {
        value = clamp(value, 0.0F, kMaxEmissive, 0.0F);
    }
    material.metallic = clamp(material.metallic, 0.0F, 1.0F, 1.0F);
    material.roughness = clamp(material.roughness, 0.0F, 1.0F, 1.0F);
    material.normal_scale = clamp(material.normal_scale, -kMaxNormalScale, kMaxNormalScale, 1.0F);
    material.occlusion_strength = clamp(material.occlusion_strength, 0.0F, 1.0F, 1.0F);
    material.alpha_cutoff = clamp(material.alpha_cutoff, 0.0F, kMaxEmissive, 0.5F);
    return material;
}

std::string printable(const std::string& name, std::size_t max_bytes)
{
    std::string result;
    std::size_t at = 0;
    while (at < name.size())
    {
        const std::size_t bytes = character_bytes(name.c_str() + at);
        const std::size_t taken = std::max<std::size_t>(1, bytes);
        if (result.size() + taken > max_bytes)
        {
            break;
        }
        result += bytes == 0 ? "?" : name.substr(at, bytes);
        at += taken;
    }
    return result;
}

}  // namespace vsplit::scene
