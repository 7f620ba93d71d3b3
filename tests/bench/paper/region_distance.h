#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/keep_region.h"

#include <cstddef>
#include <optional>

namespace vsplit::bench {

/// How far two surfaces are apart.
struct RegionDistance
{
    double rms = 0.0;  ///< The larger of both directions, model units.
    double max = 0.0;  ///< The larger of both directions (Hausdorff, sampled), model units.
    double normals =
        0.0;  ///< Mean angle to the closest point's normal over both directions, degrees.
    double inside = 0.0;   ///< As rms, of the points in a ball alone; 0 where there are none.
    double outside = 0.0;  ///< As rms, of the points outside it.
    double bounds = 0.0;   ///< Diagonal of the first surface's bounding box, model units.
};

/// Measures a surface against another with points drawn by area on both. `ball`: nothing counts every
/// point as outside. Precondition: both meshes have a triangle. Deterministic.
[[nodiscard]] RegionDistance region_distance(
    const IndexedMesh& original,
    const IndexedMesh& shown,
    std::size_t samples,
    const std::optional<precompute::KeepSphere>& ball
);

}  // namespace vsplit::bench
