#pragma once

#include "codec/stream_encoder.h"
#include "mesh/indexed_mesh.h"
#include "mesh/surface_distance.h"
#include "precompute/error_tracker.h"
#include "precompute/level_placement.h"
#include "precompute/part_schedule.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// How one level is shown.
struct LevelView
{
    int shift = 0;  ///< Bits of precision that the level does without.
    /// Vertices shown outside of their cells from here on, where the shift changes.
    std::vector<codec::Displacement> displaced;
};

/// The collapses that lead from one level to the next coarser one: batches, coarsest first.
using LevelBatches = std::vector<std::vector<codec::Collapse>>;

/// What leads from one level to the next coarser one: collapses, or components that leave.
struct LevelStep
{
    LevelBatches batches;
    RemovedParts parts;  ///< Where there are some, there are no batches.
};

/// Chooses the precision of every level and where it shows its vertices, and measures what it then
/// looks like. A level whose surface is e grid units (rms) off does without floor(log2(3 e)) bits: finer
/// positions would not be seen. Where something is to be kept, its error counts as much as that of the
/// whole. Not thread safe.
class LevelMeter
{
public:
    /// Starts with the complete mesh. `source`: its tree left out; `importance`: V numbers, above 0 for
    /// what the publisher wants to keep, or empty; both must outlive the meter. `threads`: at least 1; no
    /// result depends on it. Cost: one tree of the source.
    LevelMeter(const PlacementSource& source, std::span<const float> importance, unsigned threads);

    /// Goes on to the next coarser level. Cost: about half a microsecond a collapse.
    void add(const LevelStep& level);

    /// Tells how levels are shown, when the last one was added. Result: one entry for the base and one a
    /// level, coarsest first; shifts never grow towards the finest, which has 0.
    /// Cost: about a microsecond a vertex.
    [[nodiscard]] std::vector<LevelView> choose();

    /// Measures every level as it is shown. `levels`: the same that were added, coarsest first; `views`:
    /// from choose(). Result: one entry for the base and one a level, grid units. Distances are
    /// sampled: the rms is that of many more samples to about 5 %. Cost: as add(). Afterwards the meter
    /// is of no more use.
    [[nodiscard]] std::vector<SurfaceDistance> measure(
        std::span<const LevelStep> levels, std::span<const LevelView> views
    );

private:
    PlacementSource source_;
    unsigned threads_;
    ErrorTracker tracker_;
    /// Notes that the coarsest level so far is to be placed, with those finer ones that have its shift.
    void place();

    std::vector<PlacedLevels> placed_;  ///< Finest first; they count levels from the finest.
    std::vector<int> shifts_;           ///< Finest first.
    std::size_t vertices_ = 0;          ///< Of the coarsest level so far.
};

}  // namespace vsplit::precompute
