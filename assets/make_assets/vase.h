#pragma once

#include "mesh/surface.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vsplit::assets {

/// A fluted vase, y up, about 1.2 units high: one closed surface of genus 0. Texture coordinates with seams,
/// authored normals with hard edges at foot and rim, colours; two groups, clay and glaze.
[[nodiscard]] Surface make_vase();

/// Its texture as a PNG file: 128 x 128 pixels of 16 colours, stored without compression.
[[nodiscard]] std::vector<std::byte> vase_png();

/// Writes a surface as Wavefront OBJ with four digits behind the point. `surface`: with texture
/// coordinates, normals and colours by vertex, in this order; `library`: name of the MTL file;
/// `materials`: by group.
[[nodiscard]] std::string obj_text(
    const Surface& surface, const std::string& library, const std::vector<std::string>& materials
);

/// The materials of the vase as an MTL file.
[[nodiscard]] std::string vase_mtl();

}  // namespace vsplit::assets
