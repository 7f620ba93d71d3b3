#pragma once

#include "codec/batch_coder.h"
#include "codec/growth_coder.h"
#include "codec/stream_encoder.h"
#include "core/result.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::codec {

/// What an encoder tries to predict positions from: scans are followed best along their surface, designed
/// and subdivided meshes along their curves.
inline constexpr std::array<PredictionShares, 3> kPredictions{
    {{.surface = 0, .curved = 0}, {.surface = 3, .curved = 0}, {.surface = 0, .curved = 8}}};

/// Whether the rest of a stream may come as one level, which is not seen before it is complete.
enum class GrowthStart : std::uint8_t
{
    Never,     ///< A prefix shows too little.
    IfShort,   ///< It would do if the rest is short beside it.
    IfNeeded,  ///< It would do, but more is better.
    Now,       ///< It shows enough.
};

/// Judges a prefix. `level`: the last one it has; `bytes`: of its chunks, attributes excluded.
[[nodiscard]] GrowthStart growth_start(
    const StreamPlan& plan, std::size_t level, std::size_t bytes
);

/// Says whether a mesh is so regular that its growth is short beside the prefix: then little is lost while
/// nothing new shows. `prefix`, `growth`: bytes.
[[nodiscard]] bool growth_is_short(std::size_t prefix, std::size_t growth);

/// Says whether growing makes a stream so much smaller than splits that nothing need show meanwhile.
/// `grown`, `split`: bytes of the streams.
[[nodiscard]] bool growth_pays(std::size_t grown, std::size_t split);

/// A coded growth.
struct CodedGrowth
{
    std::vector<std::vector<std::byte>> chunks;  ///< Without checksums.
    std::vector<std::uint32_t> sources;          ///< By vertex of the stream that of the source.
};

/// Codes the growth of a mesh over the coarse mesh in `state`, in chunks within proto::kTargetChunkBytes, with
/// those predictions by which it gets shortest. `mesh`: the complete one; `place`: by vertex its number in the
/// coarse mesh, or GrowthSource::kNone. Result: nothing when the mesh cannot grow.
/// Errors: Internal (not a manifold, a component without a coarse vertex), BadChunk (the border gets longer than
/// it may). Cost: about two microseconds a vertex.
[[nodiscard]] Result<std::optional<CodedGrowth>> try_growth(
    const GridMesh& mesh, std::span<const std::uint32_t> place, const BatchState& state
);

}  // namespace vsplit::codec
