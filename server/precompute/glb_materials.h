#pragma once

#include "precompute/model_view.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace vsplit::precompute {

/// Builds the parts of a glTF document that say how a surface looks. Not thread safe.
/// Source: Khronos, "glTF 2.0 Specification", 2021, sections 3.8 and 3.9.
class GlbMaterials
{
public:
    /// `tex_coord_sets`: for every texture coordinate set of the model its number in the file; a texture
    /// on other ones is left out. Both must outlive the object.
    GlbMaterials(const ModelView& model, const std::map<std::uint8_t, int>& tex_coord_sets)
        : model_(model), tex_coord_sets_(tex_coord_sets)
    {
    }

    /// Puts materials, textures and samplers into a document, and images that refer to buffer views
    /// still to come: their number stands for that of the image in used_images().
    void add_to(nlohmann::json& document);

    /// The images that the document uses, in its order.
    [[nodiscard]] const std::vector<std::int32_t>& used_images() const { return used_images_; }

private:
    [[nodiscard]] nlohmann::json material_object(const Material& material);
    void add_texture(
        nlohmann::json& parent, const char* name, const TextureUse& use, nlohmann::json extra
    );
    [[nodiscard]] int texture_index(const TextureUse& use);
    [[nodiscard]] int sampler_index(const TextureUse& use);

    const ModelView& model_;
    const std::map<std::uint8_t, int>& tex_coord_sets_;
    std::vector<std::int32_t> used_images_;
    std::map<std::pair<int, int>, int> texture_ids_;  ///< By image and sampler.
    std::map<std::pair<TextureWrap, TextureWrap>, int> sampler_ids_;
    nlohmann::json textures_ = nlohmann::json::array();
    nlohmann::json samplers_ = nlohmann::json::array();
};

}  // namespace vsplit::precompute
