#pragma once

#include "codec/connectivity_model.h"
#include "codec/refinement_mesh.h"
#include "codec/stream_encoder.h"
#include "core/result.h"

#include <cstdint>
#include <span>

namespace vsplit::codec {

/// Finds where the collapses of a batch are in the mesh that they led to.
/// `mesh`: with its faces in order (after start_batch()); `place`: by vertex of the plan its number in
/// the mesh. Error: Internal when stars overlap. Cost: linear in the mesh.
[[nodiscard]] Result<SplitPlan> plan_splits(
    const RefinementMesh& mesh,
    std::span<const std::uint32_t> place,
    std::span<const Collapse> batch
);

}  // namespace vsplit::codec
