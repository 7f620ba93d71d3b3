#pragma once

#include "codec/stream_encoder.h"
#include "mesh/indexed_mesh.h"
#include "mesh/surface_distance.h"
#include "precompute/level_placement.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// How one level is shown and how far that is from the source.
struct LevelError
{
    int shift = 0;  ///< Bits of precision that the level does without.
    /// Vertices shown outside of their cells from here on, where the shift changes.
    std::vector<codec::Displacement> displaced;
    SurfaceDistance distance;  ///< Grid units.
};

/// The collapses that lead from one level to the next coarser one: batches, coarsest first.
using LevelBatches = std::vector<std::vector<codec::Collapse>>;

/// Chooses the precision of every level and where it shows its vertices, and measures what it then
/// looks like. `source`: the complete mesh, its tree left out;
/// `levels`: the collapses of every level but the base, coarsest first; `importance`: V numbers, above
/// 0 for what the publisher wants to keep, or empty;
/// `threads`: at least 1; `progress`: called with the share done, 0 .. 1.
/// A level whose surface is e grid units (rms) off does without floor(log2(3 e)) bits: finer positions
/// would not be seen. Where something is to be kept, its error counts as much as that of the whole.
/// Result: one entry for the base and one a level; shifts never grow towards the
/// finest, which has 0. Distances are sampled: the rms is that of many more samples to about 5 %.
/// Cost: about three microseconds a vertex. Deterministic for any number of threads.
[[nodiscard]] std::vector<LevelError> measure_levels(
    const PlacementSource& source,
    std::span<const LevelBatches> levels,
    std::span<const float> importance,
    unsigned threads,
    const std::function<void(double)>& progress
);

}  // namespace vsplit::precompute
