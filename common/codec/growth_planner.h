#pragma once

#include "codec/batch_coder.h"
#include "codec/growth_coder.h"
#include "core/result.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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

/// Judges a prefix. `bytes`: of the chunks so far; `vertices`: of the complete mesh; `shift`: of the
/// prefix's level; `has_attributes`: the prefix will also hold attributes, not counted in `bytes`.
[[nodiscard]] GrowthStart growth_start(
    std::size_t bytes, std::uint32_t vertices, int shift, bool has_attributes
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

/// Tells with which of kPredictions the growth of a mesh over the coarse mesh in `state` gets shortest, by
/// its first vertices; nothing when the mesh cannot grow. `source`: the complete mesh, to be restarted
/// afterwards. Cost: about half a microsecond a vertex.
[[nodiscard]] std::optional<PredictionShares> choose_predictions(
    GrowthSource& source, const BatchState& state
);

/// Codes the growth of a mesh over the coarse mesh in `state`, in chunks within proto::kTargetChunkBytes.
/// `source`: the complete mesh, freshly started.
/// Errors: Internal (not a manifold, a component without a coarse vertex), BadChunk (the border gets
/// longer than it may). Cost: about a microsecond a vertex.
[[nodiscard]] Result<CodedGrowth> code_growth(
    GrowthSource& source, const BatchState& state, const PredictionShares& predicted
);

}  // namespace vsplit::codec
