#pragma once

#include "image/raster.h"
#include "mesh/surface.h"
#include "scene/appearance.h"

#include <cstdint>

namespace vsplit::client {

/// A cube of edge 2 around the origin with eight vertices. Every side has the whole of texture
/// coordinate set 0, upright, so that all edges are seams; sides are +x -x +y -y +z -z, two triangles
/// each, and side i is group i.
[[nodiscard]] Surface cube_surface();

/// An image of two by two fields: red and green above, blue and white below.
/// `side`: pixels, even.
[[nodiscard]] Raster four_fields(std::uint32_t side);

/// One material per side of cube_surface(), and one image of four_fields(256).
[[nodiscard]] Appearance cube_appearance();

}  // namespace vsplit::client
