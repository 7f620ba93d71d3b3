#include "scene/appearance_chunk.h"

#include "appearance_generated.h"
#include "scene/appearance_rules.h"

#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace vsplit::scene {

namespace {

/// Every FlatBuffers builder ends on this boundary, so a payload that does not was cut.
constexpr std::size_t kPayloadUnit = 4;
constexpr flatbuffers::uoffset_t kMaxDepth = 4;
constexpr std::uint16_t kNoMaterial = std::numeric_limits<std::uint16_t>::max();

using Builder = flatbuffers::FlatBufferBuilder;
using Strings = flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>;

tl::unexpected<Error> bad(std::string message)
{
    return fail(ErrorCode::BadChunk, std::move(message));
}

Result<void> check(const Appearance& appearance)
{
    const AppearanceLimits limits;
    if (appearance.materials.size() > limits.max_materials ||
        appearance.groups.size() > limits.max_groups ||
        appearance.images.size() > limits.max_images)
    {
        return fail(ErrorCode::InputTooLarge, "there are too many materials, groups or images");
    }
    for (const Material& material : appearance.materials)
    {
        if (!is_valid(clamped(material), appearance.images.size()))
        {
            return fail(ErrorCode::BadIndex, "a material uses a texture that does not exist");
        }
    }
    for (const FaceGroup& group : appearance.groups)
    {
        if (group.material < -1 ||
            group.material >= static_cast<std::int64_t>(appearance.materials.size()))
        {
            return fail(ErrorCode::BadIndex, "a group has a material that does not exist");
        }
    }
    for (const ImageInfo& image : appearance.images)
    {
        if (!is_valid(image, limits))
        {
            return fail(ErrorCode::BadIndex, "an image has an impossible size");
        }
    }
    return {};
}

fb::TextureUse packed(const TextureUse& use)
{
    const auto wrap = static_cast<unsigned>(use.wrap_u) | static_cast<unsigned>(use.wrap_v) << 4U;
    return {
        static_cast<std::uint16_t>(use.image), use.tex_coord_set, static_cast<std::uint8_t>(wrap)};
}

TextureUse unpacked(const fb::TextureUse* use)
{
    if (use == nullptr)
    {
        return {};
    }
    return {
        .image = use->image(),
        .tex_coord_set = use->tex_coord_set(),
        .wrap_u = static_cast<TextureWrap>(use->wrap() & 15U),
        .wrap_v = static_cast<TextureWrap>(use->wrap() >> 4U),
    };
}

void add_textures(const Material& material, fb::MaterialBuilder& table)
{
    const auto add = [&](const TextureUse& use, flatbuffers::voffset_t field) {
        if (use.image >= 0)
        {
            const fb::TextureUse value = packed(use);
            table.fbb_.AddStruct(field, &value);
        }
    };
    add(material.base_color_texture, fb::Material::VT_BASE_COLOR_TEXTURE);
    add(material.metallic_roughness_texture, fb::Material::VT_METALLIC_ROUGHNESS_TEXTURE);
    add(material.normal_texture, fb::Material::VT_NORMAL_TEXTURE);
    add(material.occlusion_texture, fb::Material::VT_OCCLUSION_TEXTURE);
    add(material.emissive_texture, fb::Material::VT_EMISSIVE_TEXTURE);
}

flatbuffers::Offset<fb::Material> write_material(
    const Material& given, bool with_names, Builder& builder
)
{
    const Material material = clamped(given);
    const bool named = with_names && !material.name.empty();
    const auto name =
        named ? builder.CreateString(printable(material.name, AppearanceLimits{}.max_name_bytes))
              : flatbuffers::Offset<flatbuffers::String>();
    fb::MaterialBuilder table(builder);
    if (named)
    {
        table.add_name(name);
    }
    if (material.base_color != Material{}.base_color)
    {
        const auto& c = material.base_color;
        const fb::Rgba color(c[0], c[1], c[2], c[3]);
        table.add_base_color(&color);
    }
    if (material.emissive != Material{}.emissive)
    {
        const auto& c = material.emissive;
        const fb::Rgb color(c[0], c[1], c[2]);
        table.add_emissive(&color);
    }
    table.add_metallic(material.metallic);
    table.add_roughness(material.roughness);
    table.add_normal_scale(material.normal_scale);
    table.add_occlusion_strength(material.occlusion_strength);
    table.add_alpha_mode(static_cast<std::uint8_t>(material.alpha_mode));
    table.add_alpha_cutoff(material.alpha_cutoff);
    table.add_double_sided(material.double_sided);
    add_textures(material, table);
    return table.Finish();
}

/// Names of groups or images; no vector when none has one.
template <typename Named>
flatbuffers::Offset<Strings> write_names(
    const std::vector<Named>& list, bool with_names, Builder& builder
)
{
    const auto has_name = [](const Named& item) { return !item.name.empty(); };
    if (!with_names || std::none_of(list.begin(), list.end(), has_name))
    {
        return {};
    }
    std::vector<flatbuffers::Offset<flatbuffers::String>> names;
    names.reserve(list.size());
    for (const Named& item : list)
    {
        names.push_back(
            builder.CreateSharedString(printable(item.name, AppearanceLimits{}.max_name_bytes))
        );
    }
    return builder.CreateVector(names);
}

/// Gives a list the names that a chunk has for it.
template <typename Named>
Result<void> read_names(
    const Strings* names, std::vector<Named>& list, const AppearanceLimits& limits
)
{
    if (names == nullptr)
    {
        return {};
    }
    if (names->size() != list.size())
    {
        return bad("there are not as many names as groups or images");
    }
    for (flatbuffers::uoffset_t i = 0; i < names->size(); ++i)
    {
        const flatbuffers::String* const name = names->Get(i);
        if (name->size() > limits.max_name_bytes || !is_valid_name(name->str(), name->size()))
        {
            return bad("a name is too long or not printable");
        }
        list[i].name = name->str();
    }
    return {};
}

Result<Material> read_material(
    const fb::Material& table, std::size_t images, const AppearanceLimits& limits
)
{
    Material material;
    if (table.name() != nullptr)
    {
        if (table.name()->size() > limits.max_name_bytes ||
            !is_valid_name(table.name()->str(), table.name()->size()))
        {
            return bad("a material's name is too long or not printable");
        }
        material.name = table.name()->str();
    }
    if (const fb::Rgba* c = table.base_color())
    {
        material.base_color = {c->r(), c->g(), c->b(), c->a()};
    }
    if (const fb::Rgb* c = table.emissive())
    {
        material.emissive = {c->r(), c->g(), c->b()};
    }
    material.metallic = table.metallic();
    material.roughness = table.roughness();
    material.normal_scale = table.normal_scale();
    material.occlusion_strength = table.occlusion_strength();
    material.alpha_mode = static_cast<AlphaMode>(table.alpha_mode());
    material.alpha_cutoff = table.alpha_cutoff();
    material.double_sided = table.double_sided();
    material.base_color_texture = unpacked(table.base_color_texture());
    material.metallic_roughness_texture = unpacked(table.metallic_roughness_texture());
    material.normal_texture = unpacked(table.normal_texture());
    material.occlusion_texture = unpacked(table.occlusion_texture());
    material.emissive_texture = unpacked(table.emissive_texture());
    if (!is_valid(material, images))
    {
        return bad("a material has a value out of range");
    }
    return material;
}

template <typename Vector>
std::size_t size_of(const Vector* vector)
{
    return vector == nullptr ? 0 : vector->size();
}

Result<Appearance> read(const fb::Appearance& table, const AppearanceLimits& limits)
{
    if (size_of(table.materials()) > limits.max_materials ||
        size_of(table.group_materials()) > limits.max_groups ||
        size_of(table.image_sizes()) > limits.max_images)
    {
        return fail(ErrorCode::LimitExceeded, "too many materials, groups or images");
    }
    Appearance appearance;
    for (std::size_t i = 0; i < size_of(table.image_sizes()); ++i)
    {
        const auto& size = *table.image_sizes()->Get(static_cast<flatbuffers::uoffset_t>(i));
        const ImageInfo image{
            .name = {},
            .width = size.width(),
            .height = size.height(),
            .channels = size.channels(),
        };
        if (!is_valid(image, limits))
        {
            return bad("an image has an impossible size");
        }
        appearance.images.push_back(image);
    }
    for (std::size_t i = 0; i < size_of(table.materials()); ++i)
    {
        auto material = read_material(
            *table.materials()->Get(static_cast<flatbuffers::uoffset_t>(i)),
            appearance.images.size(),
            limits
        );
        VSPLIT_TRY(material);
        appearance.materials.push_back(std::move(*material));
    }
    for (std::size_t i = 0; i < size_of(table.group_materials()); ++i)
    {
        const auto number = table.group_materials()->Get(static_cast<flatbuffers::uoffset_t>(i));
        if (number != kNoMaterial && number >= appearance.materials.size())
        {
            return bad("a group has a material that does not exist");
        }
        appearance.groups.push_back({.name = {}, .material = number == kNoMaterial ? -1 : number});
    }
    VSPLIT_TRY(read_names(table.group_names(), appearance.groups, limits));
    VSPLIT_TRY(read_names(table.image_names(), appearance.images, limits));
    return appearance;
}

}  // namespace

Result<std::vector<std::byte>> encode_appearance(const Appearance& appearance, bool with_names)
{
    VSPLIT_TRY(check(appearance));
    Builder builder;
    const auto group_names = write_names(appearance.groups, with_names, builder);
    const auto image_names = write_names(appearance.images, with_names, builder);
    std::vector<flatbuffers::Offset<fb::Material>> materials;
    for (const Material& material : appearance.materials)
    {
        materials.push_back(write_material(material, with_names, builder));
    }
    std::vector<std::uint16_t> groups;
    for (const FaceGroup& group : appearance.groups)
    {
        groups.push_back(
            group.material < 0 ? kNoMaterial : static_cast<std::uint16_t>(group.material)
        );
    }
    std::vector<fb::ImageSize> images;
    for (const ImageInfo& image : appearance.images)
    {
        images.emplace_back(
            static_cast<std::uint16_t>(image.width),
            static_cast<std::uint16_t>(image.height),
            image.channels
        );
    }
    const auto material_vector = materials.empty() ? 0 : builder.CreateVector(materials);
    const auto group_vector = groups.empty() ? 0 : builder.CreateVector(groups);
    const auto image_vector = images.empty() ? 0 : builder.CreateVectorOfStructs(images);
    builder.Finish(fb::CreateAppearance(
        builder, material_vector, group_vector, group_names, image_vector, image_names
    ));
    const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Result<Appearance> decode_appearance(
    std::span<const std::byte> payload, const AppearanceLimits& limits
)
{
    if (payload.size() > limits.max_bytes)
    {
        return fail(ErrorCode::LimitExceeded, "an appearance chunk is too long");
    }
    if (payload.empty() || payload.size() % kPayloadUnit != 0)
    {
        return bad("an appearance chunk has an impossible length");
    }
    // A copy that is aligned: FlatBuffers reads numbers in place, and some processors fault on others.
    std::vector<std::uint64_t> storage((payload.size() + 7) / 8);
    std::memcpy(storage.data(), payload.data(), payload.size());
    const auto* const data = reinterpret_cast<const std::uint8_t*>(storage.data());
    const auto max_tables = static_cast<flatbuffers::uoffset_t>(limits.max_materials + 1);
    flatbuffers::Verifier verifier(data, payload.size(), kMaxDepth, max_tables);
    if (!verifier.VerifyBuffer<fb::Appearance>(nullptr))
    {
        return bad("an appearance chunk is malformed");
    }
    return read(*flatbuffers::GetRoot<fb::Appearance>(data), limits);
}

}  // namespace vsplit::scene
