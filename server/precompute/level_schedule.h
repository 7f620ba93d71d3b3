#pragma once

#include "precompute/encode_mesh.h"
#include "precompute/level_builder.h"
#include "precompute/metric.h"

#include <cstddef>

namespace vsplit::precompute {

/// The next number of vertices at which a level must end: one that the options ask for, or the base.
/// `vertices`: those that the mesh has now, or 0 to ask for the base alone; `all`: those of the source.
[[nodiscard]] std::size_t next_stop(
    const EncodeOptions& options, std::size_t vertices, std::size_t all
);

/// Bits of positions that the options leave to a last level of their own.
[[nodiscard]] int late_bits(const EncodeOptions& options);

/// How to choose the collapses of the next level of a mesh that has `vertices` left of `all`: for small
/// files while there are many, by price alone below.
[[nodiscard]] LevelStyle style_for(Metric metric, std::size_t vertices, std::size_t all);

}  // namespace vsplit::precompute
