#pragma once

#include "precompute/mesh_builder.h"
#include "precompute/model_writers.h"
#include "precompute/repair_surface.h"
#include "precompute/source_model.h"
#include "precompute/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vsplit::fuzz {

/// Stops the fuzzer when something does not hold.
inline void require(bool holds)
{
    if (!holds)
    {
        std::abort();
    }
}

/// Checks attributes of `triangles` triangles.
inline void check_attributes(const std::vector<SurfaceAttribute>& attributes, std::size_t triangles)
{
    for (const SurfaceAttribute& attribute : attributes)
    {
        require(attribute.components >= 1 && attribute.components <= 4);
        require(attribute.corners.size() == triangles);
        require(std::ranges::all_of(attribute.values, [](float value) {
            return std::isfinite(value);
        }));
        for (const Triangle& corners : attribute.corners)
        {
            require(std::ranges::max(corners) < attribute.size());
        }
    }
}

inline void check_texture(const TextureUse& use, const Appearance& appearance)
{
    require(use.image >= -1 && use.image < static_cast<std::int32_t>(appearance.images.size()));
}

/// Checks that everything in a model refers to something that is there.
inline void check_model(const precompute::SourceModel& model)
{
    const Surface& surface = model.surface;
    require(!surface.mesh.triangles.empty());
    require(std::ranges::all_of(surface.mesh.positions, precompute::is_position));
    check_attributes(surface.attributes, surface.mesh.triangles.size());
    require(surface.groups.empty() || surface.groups.size() == surface.mesh.triangles.size());
    for (const std::uint32_t group : surface.groups)
    {
        require(group < model.appearance.groups.size());
    }
    for (const FaceGroup& group : model.appearance.groups)
    {
        const auto materials = static_cast<std::int32_t>(model.appearance.materials.size());
        require(group.material >= -1 && group.material < materials);
    }
    for (const Material& material : model.appearance.materials)
    {
        check_texture(material.base_color_texture, model.appearance);
        check_texture(material.metallic_roughness_texture, model.appearance);
        check_texture(material.normal_texture, model.appearance);
        check_texture(material.occlusion_texture, model.appearance);
        check_texture(material.emissive_texture, model.appearance);
    }
    require(model.images.size() == model.appearance.images.size());
}

/// Repairs a model and writes it, as an encoder and a decoder would.
inline void check_use(const precompute::SourceModel& model)
{
    const auto repaired = precompute::repair_surface(model.surface);
    if (!repaired)
    {
        require(repaired.error().code == ErrorCode::EmptyMesh);
        return;
    }
    const IndexedMesh& mesh = repaired->repaired.mesh;
    require(precompute::check_manifold(mesh).has_value());
    check_attributes(repaired->attributes, mesh.triangles.size());
    const precompute::ModelView view{
        mesh, repaired->attributes, repaired->groups, &model.appearance, model.images};
    require(precompute::format_glb(view).has_value());
    require(!precompute::format_obj(view, "model").empty());
    require(!precompute::format_ply(view, "model").empty());
}

}  // namespace vsplit::fuzz
