#pragma once

#include "core/result.h"
#include "mesh/surface.h"
#include "scene/appearance.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace vsplit::precompute {

/// A model to be written; what it shows must outlive it.
struct ModelView
{
    const IndexedMesh& mesh;
    std::span<const SurfaceAttribute> attributes{};  ///< Corners and values finite and in range.
    std::span<const std::uint32_t> groups{};         ///< By triangle; empty: all in 0.
    const Appearance* appearance = nullptr;          ///< Nothing: no materials, groups or images.
    std::span<const SourceImage> images{};  ///< As Appearance::images; empty ones are left out.
};

/// Shows a surface with its appearance. `images`: as Appearance::images. All must outlive the result.
[[nodiscard]] inline ModelView view_model(
    const Surface& surface, const Appearance& appearance, std::span<const SourceImage> images
)
{
    return {surface.mesh, surface.attributes, surface.groups, &appearance, images};
}

}  // namespace vsplit::precompute
