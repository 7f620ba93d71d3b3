#pragma once

#include "codec/stream_encoder.h"
#include "precompute/encode_mesh.h"
#include "precompute/level_errors.h"
#include "precompute/part_schedule.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vsplit::precompute {

/// What is encoded, in an order in which neighbours are near in memory.
struct Source
{
    QuantizationGrid grid;
    GridMesh quantised;
    std::vector<Vector3> exact;  ///< Positions in grid units, not rounded.
    std::vector<std::uint32_t> stitches;
    std::vector<std::uint8_t> locked;  ///< Vertices that are never shown elsewhere; or empty.
    std::vector<float> importance;
    std::vector<float> weights;         ///< What the metric needs.
    std::vector<Triangle> wedges;       ///< By triangle those at its corners; or empty.
    std::vector<std::uint32_t> groups;  ///< By triangle; or empty.
    std::vector<codec::AttributeInfo> attributes;
    std::vector<std::vector<std::int32_t>> values;  ///< By attribute and wedge.
};

/// The steps from the complete mesh to the base.
struct Sequence
{
    std::vector<LevelStep> levels;     ///< Finest first, one batch each, until order_levels().
    std::vector<std::uint8_t> starts;  ///< By step 1 when it may not join the level before it.
    std::vector<std::vector<codec::SeamRecord>> seams;  ///< By batch, if there are wedges.
    std::vector<Triangle> base;                         ///< The triangles that it leaves.
};

/// Called with every step as soon as it is known; `is_level`: it will not be joined with others.
using StepSink = std::function<void(const LevelStep& step, bool is_level)>;

/// Collapses a mesh and takes components out until only the base is left.
/// `source`: its weights are taken; `parts`: of the same mesh. Cost: most of an encode's. Deterministic.
[[nodiscard]] Sequence make_sequence(
    Source& source,
    const EncodeOptions& options,
    const ProgressSink& progress,
    PartSchedule& parts,
    const StepSink& take_step
);

/// Turns a sequence round, coarsest first, and joins small batches into one level until it is worth its own
/// chunks. `source`: what the sequence was made of.
void order_levels(Sequence& sequence, const Source& source);

}  // namespace vsplit::precompute
