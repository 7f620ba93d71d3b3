#pragma once

#include "core/result.h"
#include "image.h"
#include "image/raster.h"
#include "renderer.h"
#include "scene/appearance.h"
#include "surface_arrays.h"
#include "view.h"

#include <span>

namespace vsplit::client {

/// Draws a surface with its materials off screen, as vsplit-pda shows it.
/// `appearance`: may be null; `images`: by image of the appearance, one without pixels is not there yet;
/// there may be fewer. Errors: those of Renderer; LimitExceeded for what the driver has no memory for.
/// Cost: opens OpenGL ES each time, some 50 ms in software.
[[nodiscard]] Result<Image> surface_picture(
    const SurfaceArrays& arrays,
    const Appearance* appearance,
    std::span<const Raster> images,
    const View& view,
    const RenderOptions& options = {}
);

}  // namespace vsplit::client
