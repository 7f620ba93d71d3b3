#pragma once

#include "precompute/image_collector.h"
#include "precompute/source_model.h"
#include "scene/appearance.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <tiny_gltf.h>
#include <vector>

namespace vsplit::precompute {

/// Moves texture coordinates: (u, v) becomes (m0 u + m1 v + m2, m3 u + m4 v + m5).
using UvTransform = std::array<double, 6>;

/// Takes over the materials that are used. Not thread safe. Safe on untrusted input.
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.9; "KHR_texture_transform", 2018.
class GltfMaterials
{
public:
    /// All three must outlive the object. `dropped`: gets notes for extensions and textures that are
    /// not taken over.
    GltfMaterials(const tinygltf::Model& model, ImageCollector& images, DroppedNotes& dropped)
        : model_(model), images_(images), dropped_(dropped)
    {
    }

    /// The material of a primitive. Result: its index in what finish() gives; -1: none.
    std::int32_t use(int material);

    /// How the texture coordinates of a set must be moved for a material that use() gave, so that its
    /// textures need no transformation of their own; nothing for those that stay.
    [[nodiscard]] std::optional<UvTransform> transform(std::int32_t material, std::uint8_t set)
        const;

    /// Takes the materials.
    [[nodiscard]] std::vector<Material> finish() { return std::move(materials_); }

private:
    /// Transformations by texture coordinate set.
    using Transforms = std::map<std::uint8_t, UvTransform>;

    [[nodiscard]] Material convert(const tinygltf::Material& source);
    void note_extensions(const tinygltf::Material& source);
    [[nodiscard]] TextureUse convert_texture(
        int texture, int tex_coord, const tinygltf::ExtensionMap& extensions
    );
    [[nodiscard]] std::int32_t convert_image(int image);
    void take_transform(std::uint8_t set, const UvTransform& transform);

    const tinygltf::Model& model_;
    ImageCollector& images_;
    DroppedNotes& dropped_;
    std::vector<Material> materials_;
    std::vector<Transforms> transforms_;     ///< One for each of materials_.
    std::map<int, std::int32_t> known_;      ///< By the file's material.
    std::map<int, std::int32_t> image_ids_;  ///< By the file's image.
};

}  // namespace vsplit::precompute
