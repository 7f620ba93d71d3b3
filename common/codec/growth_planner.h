#pragma once

#include "codec/batch_coder.h"
#include "codec/growth_coder.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Weights of the coarse surface that an encoder tries, eighths.
inline constexpr std::array<int, 2> kSurfaceShares{0, 3};

/// How a growth is cut into chunks, and what it costs.
struct GrowthPlan
{
    std::vector<GrowthShare> chunks;
    int surface_share = 0;
    std::size_t bytes = 0;  ///< Estimate of all chunks together.
};

/// Says whether a prefix shows enough for the rest to come as one level, which is not seen before it is
/// complete. `bytes`: of the chunks so far; `vertices`: of the complete mesh; `shift`: of the prefix's level.
[[nodiscard]] bool shows_enough(std::size_t bytes, std::uint32_t vertices, int shift);

/// Finds where to cut the growth of a mesh over the coarse mesh in `state`, without writing it.
/// `mesh`: the complete mesh; `coarse`: by its vertices their numbers in the coarse mesh, or
/// GrowthSource::kNone.
/// Errors: Internal (not a manifold, a component without a coarse vertex), BadChunk (the border gets
/// longer than it may). Cost: one coding of the mesh, about a microsecond a vertex.
[[nodiscard]] Result<GrowthPlan> plan_growth(
    const GridMesh& mesh,
    std::span<const std::uint32_t> coarse,
    const BatchState& state,
    int surface_share
);

/// Plans with every weight of kSurfaceShares and returns the shortest; nothing when the mesh cannot
/// grow. Arguments as for plan_growth().
[[nodiscard]] std::optional<GrowthPlan> cheapest_growth(
    const GridMesh& mesh, std::span<const std::uint32_t> coarse, const BatchState& state
);

}  // namespace vsplit::codec
