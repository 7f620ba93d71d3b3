#pragma once

#include "precompute/image_collector.h"
#include "precompute/source_model.h"
#include "scene/appearance.h"

#include <string_view>
#include <vector>

namespace vsplit::precompute {

/// Reads the materials of an MTL file: Kd, Ke, d, Tr, Ns, Pm, Pr, map_Kd, map_Ke, map_Bump and norm;
/// others are noted. Metallic is 0 unless Pm says otherwise; Ns becomes a roughness, 1 when neither
/// it nor Pr is there.
/// `text`: the whole file; `images`: takes the textures; `dropped`: gets notes. Result: the materials in
/// file order; the first of a name counts. Cost: linear. Safe on untrusted input.
/// Source: Wavefront, "MTL material format", 1995; Pm and Pr: Exocortex, "PBR extension for MTL", 2015;
/// roughness of a Blinn-Phong exponent: Karis, "Specular BRDF Reference", 2013.
[[nodiscard]] std::vector<Material> read_material_library(
    std::string_view text, ImageCollector& images, DroppedNotes& dropped
);

}  // namespace vsplit::precompute
