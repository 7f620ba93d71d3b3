#pragma once

#include "scene/appearance.h"
#include "surface_arrays.h"

#include <cstdint>
#include <span>

namespace vsplit::client {

/// Sorts the triangles by material and finds the ranges: what hides first, one range a material, then
/// what one sees through, one range a group, as these are drawn from far to near.
/// `groups`: by triangle; empty: all 0; `appearance`: may be null; groups and materials that it does
/// not have count as none. Cost: linear in triangles, groups and materials. Safe on untrusted groups.
void sort_by_material(
    SurfaceArrays& arrays, std::span<const std::uint32_t> groups, const Appearance* appearance
);

}  // namespace vsplit::client
