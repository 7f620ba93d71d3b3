// Based on: Khronos, "glTF 2.0 Specification", 2021, section 3.9; "KHR_texture_transform", 2018.
#include "precompute/gltf_materials.h"

#include "precompute/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr const char* kTransformName = "KHR_texture_transform";
constexpr UvTransform kIdentity{1.0, 0.0, 0.0, 0.0, 1.0, 0.0};

float finite(double value, float otherwise)
{
    return std::abs(value) < 1e30 ? static_cast<float>(value) : otherwise;
}

float unit(double value, float otherwise)
{
    return std::clamp(finite(value, otherwise), 0.0F, 1.0F);
}

TextureWrap wrap_of(int wrap)
{
    switch (wrap)
    {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return TextureWrap::Clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return TextureWrap::Mirror;
        default:
            return TextureWrap::Repeat;
    }
}

double number_at(const tinygltf::Value& list, int index, double otherwise)
{
    const bool there = list.IsArray() && list.ArrayLen() > static_cast<std::size_t>(index) &&
                       list.Get(index).IsNumber();
    const double value = there ? list.Get(index).GetNumberAsDouble() : otherwise;
    return std::abs(value) < 1e9 ? value : otherwise;
}

/// T R S of the extension, multiplied out.
UvTransform transform_of(const tinygltf::Value& object)
{
    const tinygltf::Value& offset = object.Get("offset");
    const tinygltf::Value& scale = object.Get("scale");
    const tinygltf::Value& rotation = object.Get("rotation");
    const double angle = rotation.IsNumber() ? rotation.GetNumberAsDouble() : 0.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double x = number_at(scale, 0, 1.0);
    const double y = number_at(scale, 1, 1.0);
    return {c * x, s * y, number_at(offset, 0, 0.0), -s * x, c * y, number_at(offset, 1, 0.0)};
}

AlphaMode alpha_mode_of(const std::string& name)
{
    if (name == "MASK")
    {
        return AlphaMode::Mask;
    }
    return name == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
}

}  // namespace

std::int32_t GltfMaterials::use(int material)
{
    if (material < 0 || static_cast<std::size_t>(material) >= model_.materials.size())
    {
        return -1;
    }
    const auto next = static_cast<std::int32_t>(materials_.size());
    const auto [entry, is_new] = known_.try_emplace(material, next);
    if (is_new)
    {
        transforms_.emplace_back();
        materials_.push_back(convert(model_.materials[static_cast<std::size_t>(material)]));
    }
    return entry->second;
}

std::optional<UvTransform> GltfMaterials::transform(std::int32_t material, std::uint8_t set) const
{
    if (material < 0)
    {
        return std::nullopt;
    }
    const Transforms& transforms = transforms_[static_cast<std::size_t>(material)];
    const auto found = transforms.find(set);
    const bool moves = found != transforms.end() && found->second != kIdentity;
    return moves ? std::optional(found->second) : std::nullopt;
}

Material GltfMaterials::convert(const tinygltf::Material& source)
{
    Material material;
    material.name = source.name;
    const auto& pbr = source.pbrMetallicRoughness;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, pbr.baseColorFactor.size()); ++i)
    {
        material.base_color[i] = unit(pbr.baseColorFactor[i], 1.0F);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(3, source.emissiveFactor.size()); ++i)
    {
        material.emissive[i] = unit(source.emissiveFactor[i], 0.0F);
    }
    material.metallic = unit(pbr.metallicFactor, 1.0F);
    material.roughness = unit(pbr.roughnessFactor, 1.0F);
    material.normal_scale = finite(source.normalTexture.scale, 1.0F);
    material.occlusion_strength = unit(source.occlusionTexture.strength, 1.0F);
    material.alpha_mode = alpha_mode_of(source.alphaMode);
    material.alpha_cutoff = std::max(finite(source.alphaCutoff, 0.5F), 0.0F);
    material.double_sided = source.doubleSided;
    const auto convert_one = [this](const auto& texture) {
        return convert_texture(texture.index, texture.texCoord, texture.extensions);
    };
    // The base colour comes first: its transformation is kept when they contradict each other.
    material.base_color_texture = convert_one(pbr.baseColorTexture);
    material.metallic_roughness_texture = convert_one(pbr.metallicRoughnessTexture);
    material.normal_texture = convert_one(source.normalTexture);
    material.occlusion_texture = convert_one(source.occlusionTexture);
    material.emissive_texture = convert_one(source.emissiveTexture);
    note_extensions(source);
    return material;
}

void GltfMaterials::note_extensions(const tinygltf::Material& source)
{
    for (const auto& [name, value] : source.extensions)
    {
        dropped_.add("extension " + name + " of a material");
    }
}

TextureUse GltfMaterials::convert_texture(
    int texture, int tex_coord, const tinygltf::ExtensionMap& extensions
)
{
    if (texture < 0 || static_cast<std::size_t>(texture) >= model_.textures.size())
    {
        return {};
    }
    UvTransform transform = kIdentity;
    const auto extension = extensions.find(kTransformName);
    if (extension != extensions.end() && extension->second.IsObject())
    {
        transform = transform_of(extension->second);
        const tinygltf::Value& other = extension->second.Get("texCoord");
        tex_coord = other.IsInt() ? other.GetNumberAsInt() : tex_coord;
    }
    constexpr int kMostSets = 8;
    if (tex_coord < 0 || tex_coord >= kMostSets)
    {
        dropped_.add("a texture on texture coordinates " + std::to_string(tex_coord));
        return {};
    }
    const tinygltf::Texture& source = model_.textures[static_cast<std::size_t>(texture)];
    TextureUse use;
    use.image = convert_image(source.source);
    if (use.image < 0)
    {
        return {};
    }
    use.tex_coord_set = static_cast<std::uint8_t>(tex_coord);
    const auto sampler = static_cast<std::size_t>(source.sampler);
    if (source.sampler >= 0 && sampler < model_.samplers.size())
    {
        use.wrap_u = wrap_of(model_.samplers[sampler].wrapS);
        use.wrap_v = wrap_of(model_.samplers[sampler].wrapT);
    }
    take_transform(use.tex_coord_set, transform);
    return use;
}

void GltfMaterials::take_transform(std::uint8_t set, const UvTransform& transform)
{
    const auto [entry, is_new] = transforms_.back().try_emplace(set, transform);
    if (!is_new && entry->second != transform)
    {
        dropped_.add("a second transformation of the same texture coordinates");
    }
}

std::int32_t GltfMaterials::convert_image(int image)
{
    if (image < 0 || static_cast<std::size_t>(image) >= model_.images.size())
    {
        dropped_.add("a texture without a PNG or JPEG image");
        return -1;
    }
    if (const auto known = image_ids_.find(image); known != image_ids_.end())
    {
        return known->second;
    }
    const tinygltf::Image& source = model_.images[static_cast<std::size_t>(image)];
    std::string name = !source.name.empty() ? source.name : source.uri;
    name = name.empty() ? "image " + std::to_string(image) : name;
    std::vector<std::byte> bytes;
    if (source.bufferView >= 0)
    {
        const auto view =
            view_bytes(model_, source.bufferView).value_or(std::span<const std::byte>());
        bytes.assign(view.begin(), view.end());
    }
    else
    {
        const auto raw = std::as_bytes(std::span(source.image));
        bytes.assign(raw.begin(), raw.end());
    }
    const std::int32_t index = images_.add_bytes(std::move(name), std::move(bytes));
    image_ids_.emplace(image, index);
    return index;
}

}  // namespace vsplit::precompute
