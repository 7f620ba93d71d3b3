#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vsplit {

/// How a texture goes on beyond its borders.
enum class TextureWrap : std::uint8_t
{
    Repeat = 0,
    Mirror = 1,
    Clamp = 2,
};

/// How a material treats alpha; the meanings are glTF's.
enum class AlphaMode : std::uint8_t
{
    Opaque = 0,
    Mask = 1,
    Blend = 2,
};

/// An image on a surface.
struct TextureUse
{
    std::int32_t image = -1;         ///< Index into Appearance::images; -1: no texture.
    std::uint8_t tex_coord_set = 0;  ///< Which texture coordinates place it.
    TextureWrap wrap_u = TextureWrap::Repeat;
    TextureWrap wrap_v = TextureWrap::Repeat;

    /// Memberwise equality.
    friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// A metallic-roughness material. Source: glTF 2.0, sections 3.9 and 5.19.
struct Material
{
    std::string name;
    std::array<float, 4> base_color{1.0F, 1.0F, 1.0F, 1.0F};  ///< Factors, linear.
    float metallic = 1.0F;
    float roughness = 1.0F;
    std::array<float, 3> emissive{};
    float normal_scale = 1.0F;
    float occlusion_strength = 1.0F;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;
    TextureUse base_color_texture{};
    TextureUse metallic_roughness_texture{};
    TextureUse normal_texture{};
    TextureUse occlusion_texture{};
    TextureUse emissive_texture{};

    /// Memberwise equality.
    friend bool operator==(const Material&, const Material&) = default;
};

/// Triangles that belong together: a part of the model that has one material.
struct FaceGroup
{
    std::string name;
    std::int32_t material = -1;  ///< Index into Appearance::materials; -1: none.

    /// Memberwise equality.
    friend bool operator==(const FaceGroup&, const FaceGroup&) = default;
};

/// What is known of an image before any of it came.
struct ImageInfo
{
    std::string name;
    std::uint32_t width = 0;    ///< Pixels, 1 .. 32768.
    std::uint32_t height = 0;   ///< Pixels, 1 .. 32768.
    std::uint8_t channels = 3;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.

    /// Memberwise equality.
    friend bool operator==(const ImageInfo&, const ImageInfo&) = default;
};

/// Materials of a model, and what they refer to.
struct Appearance
{
    std::vector<Material> materials;
    std::vector<FaceGroup> groups;
    std::vector<ImageInfo> images;

    /// Memberwise equality.
    friend bool operator==(const Appearance&, const Appearance&) = default;
};

/// An image as the source file has it.
struct SourceImage
{
    std::string name;
    std::vector<std::byte> bytes;  ///< A PNG or JPEG file; empty when it could not be found.
};

}  // namespace vsplit
