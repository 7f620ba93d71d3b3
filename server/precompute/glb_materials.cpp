// Based on: Khronos, "glTF 2.0 Specification", 2021, sections 3.8 and 3.9.
#include "precompute/glb_materials.h"

#include "precompute/image_header.h"

#include <algorithm>

namespace vsplit::precompute {
namespace {

using nlohmann::json;

int gl_wrap(TextureWrap wrap)
{
    switch (wrap)
    {
        case TextureWrap::Mirror:
            return 33648;
        case TextureWrap::Clamp:
            return 33071;
        case TextureWrap::Repeat:
            break;
    }
    return 10497;
}

}  // namespace

void GlbMaterials::add_to(json& document)
{
    if (model_.appearance == nullptr || model_.appearance->materials.empty())
    {
        return;
    }
    for (const Material& material : model_.appearance->materials)
    {
        document["materials"].push_back(material_object(material));
    }
    for (const std::int32_t image : used_images_)
    {
        const SourceImage& source = model_.images[static_cast<std::size_t>(image)];
        const auto header = read_image_header(source.bytes);
        const bool png = header && header->format == ImageFormat::Png;
        json object{{"mimeType", png ? "image/png" : "image/jpeg"}};
        if (!source.name.empty())
        {
            object["name"] = source.name;
        }
        document["images"].push_back(std::move(object));
    }
    if (!textures_.empty())
    {
        document["textures"] = std::move(textures_);
        document["samplers"] = std::move(samplers_);
    }
}

json GlbMaterials::material_object(const Material& material)
{
    json pbr{
        {"baseColorFactor", material.base_color},
        {"metallicFactor", material.metallic},
        {"roughnessFactor", material.roughness}};
    add_texture(pbr, "baseColorTexture", material.base_color_texture, json::object());
    add_texture(
        pbr, "metallicRoughnessTexture", material.metallic_roughness_texture, json::object()
    );
    json object{{"pbrMetallicRoughness", std::move(pbr)}};
    if (!material.name.empty())
    {
        object["name"] = material.name;
    }
    add_texture(
        object, "normalTexture", material.normal_texture, {{"scale", material.normal_scale}}
    );
    add_texture(
        object,
        "occlusionTexture",
        material.occlusion_texture,
        {{"strength", material.occlusion_strength}}
    );
    add_texture(object, "emissiveTexture", material.emissive_texture, json::object());
    if (material.emissive != std::array{0.0F, 0.0F, 0.0F})
    {
        object["emissiveFactor"] = material.emissive;
    }
    if (material.alpha_mode != AlphaMode::Opaque)
    {
        object["alphaMode"] = material.alpha_mode == AlphaMode::Mask ? "MASK" : "BLEND";
    }
    if (material.alpha_mode == AlphaMode::Mask)
    {
        object["alphaCutoff"] = material.alpha_cutoff;
    }
    if (material.double_sided)
    {
        object["doubleSided"] = true;
    }
    return object;
}

void GlbMaterials::add_texture(json& parent, const char* name, const TextureUse& use, json extra)
{
    const auto set = tex_coord_sets_.find(use.tex_coord_set);
    const bool there = use.image >= 0 &&
                       static_cast<std::size_t>(use.image) < model_.images.size() &&
                       set != tex_coord_sets_.end();
    if (!there || !read_image_header(model_.images[static_cast<std::size_t>(use.image)].bytes))
    {
        return;
    }
    extra["index"] = texture_index(use);
    if (set->second != 0)
    {
        extra["texCoord"] = set->second;
    }
    parent[name] = std::move(extra);
}

int GlbMaterials::texture_index(const TextureUse& use)
{
    auto image = std::ranges::find(used_images_, use.image);
    if (image == used_images_.end())
    {
        used_images_.push_back(use.image);
        image = used_images_.end() - 1;
    }
    const auto source = static_cast<int>(image - used_images_.begin());
    const int sampler = sampler_index(use);
    const auto next = static_cast<int>(textures_.size());
    const auto [entry, is_new] = texture_ids_.try_emplace({source, sampler}, next);
    if (is_new)
    {
        textures_.push_back({{"source", source}, {"sampler", sampler}});
    }
    return entry->second;
}

int GlbMaterials::sampler_index(const TextureUse& use)
{
    const auto next = static_cast<int>(samplers_.size());
    const auto [entry, is_new] = sampler_ids_.try_emplace({use.wrap_u, use.wrap_v}, next);
    if (is_new)
    {
        constexpr int kLinear = 9729;
        constexpr int kLinearMipmapLinear = 9987;
        samplers_.push_back(
            {{"magFilter", kLinear},
             {"minFilter", kLinearMipmapLinear},
             {"wrapS", gl_wrap(use.wrap_u)},
             {"wrapT", gl_wrap(use.wrap_v)}}
        );
    }
    return entry->second;
}

}  // namespace vsplit::precompute
