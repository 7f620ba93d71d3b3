#pragma once

#include "core/result.h"
#include "mesh/surface.h"
#include "precompute/repair.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vsplit::precompute {

/// A repaired mesh with what lies on it.
struct RepairedSurface
{
    RepairedMesh repaired;
    std::vector<SurfaceAttribute>
        attributes;                     ///< By triangle of the repaired mesh; see repair_surface().
    std::vector<std::uint32_t> groups;  ///< By triangle of the repaired mesh; empty: all in 0.
    std::vector<std::string> dropped;   ///< What was wrong with the attributes, in words.
};

/// Drops values that no corner has and merges those of the same bytes; the others stay in the order in
/// which the corners reach them. `attribute`: corners in range. Cost: one sort. Deterministic. Thread
/// safe.
void merge_values(SurfaceAttribute& attribute);

/// Repairs a mesh as repair_mesh() does, and takes attributes and groups along: they decide nothing, every
/// corner keeps its values, also those of faces that are turned round. Numbers that are not finite become
/// 0 and are noted; merge_values() is applied to every attribute.
/// `surface`: any triangles, model units; attributes and groups for all of them. `importance`: as
/// repair_mesh(). Errors: as repair_mesh(), and BadIndex when attributes or groups do not fit the
/// triangles. Cost: as repair_mesh(), and a sort of every attribute. Deterministic. Thread safe. Safe on
/// untrusted input.
[[nodiscard]] Result<RepairedSurface> repair_surface(
    const Surface& surface, std::span<const float> importance = {}
);

}  // namespace vsplit::precompute
