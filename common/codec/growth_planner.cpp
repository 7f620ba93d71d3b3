#include "codec/growth_planner.h"

#include "codec/bit_counter.h"

#include <algorithm>
#include <utility>

namespace vsplit::codec {
namespace {

/// Faces or vertices after which the length is looked at.
constexpr std::uint32_t kStep = 512;

/// Length at which a chunk is closed: one more step keeps it within proto::kTargetChunkBytes.
constexpr std::size_t kFullChunk = 48U * 1024U;

/// Vertices by which predictions are compared, when there are so many.
constexpr std::uint32_t kFewestTried = 4000;

/// Bits a vertex from which the rest may come as one level: finer prefixes hardly differ on a screen. Small
/// meshes have few bytes at any rate, so that less will do for them where it saves enough.
constexpr double kGrowthBits = 3.2;
constexpr double kFewestGrowthBits = 2.0;
constexpr std::uint32_t kSmallMesh = 8000;

/// Share of the shape in a prefix that also holds attributes.
constexpr double kShapeShare = 0.6;

/// The same on the full grid: without a bit missing the surface is off by about a cell.
constexpr double kGrowthBitsOnGrid = 1.2;

/// A growth of so many times the prefix is short: as it is where a mesh of ten bits a vertex begins to grow.
constexpr std::size_t kShortGrowth = 3;

/// Larger meshes are not tried, which would take a tenth of the encoder's time; neither are prefixes that
/// hardly show anything.
constexpr std::uint32_t kTriedMesh = 20000;
constexpr double kFewestTriedBits = 0.5;

/// Share of the bytes that growing has to save: less is not worth that nothing shows meanwhile.
constexpr std::size_t kSavesOneIn = 24;

}  // namespace

GrowthStart growth_start(const StreamPlan& plan, std::size_t level, std::size_t bytes)
{
    const auto later = std::span(plan.levels).subspan(level + 1);
    // What grows, grows over what is there.
    const bool all_there = std::ranges::all_of(
        later, &std::vector<std::vector<Triangle>>::empty, &PlannedLevel::parts
    );
    if (!plan.grow_last_level || plan.training != nullptr || later.empty() || !all_there)
    {
        return GrowthStart::Never;
    }
    const auto vertices = static_cast<std::uint32_t>(plan.mesh->positions.size());
    const double share = plan.wedges.empty() ? 1.0 : kShapeShare;
    const double bits = 8.0 * static_cast<double>(bytes) / (vertices * share);
    const bool is_small = vertices < kSmallMesh;
    const bool on_grid = plan.levels[level].shift == 0;
    if (bits >= kGrowthBits || (on_grid && !is_small && bits >= kGrowthBitsOnGrid))
    {
        return GrowthStart::Now;
    }
    if (is_small && bits >= kFewestGrowthBits)
    {
        return GrowthStart::IfNeeded;
    }
    return vertices < kTriedMesh && bits >= kFewestTriedBits ? GrowthStart::IfShort
                                                             : GrowthStart::Never;
}

bool growth_is_short(std::size_t prefix, std::size_t growth)
{
    return growth <= kShortGrowth * prefix;
}

bool growth_pays(std::size_t grown, std::size_t split)
{
    return grown + split / kSavesOneIn <= split;
}

namespace {

/// Bytes of a growth up to some vertices.
Result<std::size_t> measure_growth(
    GrowthSource& source, const BatchState& state, const PredictionShares& predicted
)
{
    BatchState trial = state;
    Growth growth(source.vertex_count(), source.face_count());
    BitCounter bits;
    VSPLIT_TRY(growth.begin(bits, trial, predicted));
    const std::uint32_t vertices =
        std::min(source.vertex_count(), std::max(kFewestTried, source.vertex_count() / 8));
    VSPLIT_TRY(growth.extend(bits, trial, {.faces = source.face_count()}, &source));
    VSPLIT_TRY(growth.extend(bits, trial, {.vertices = vertices}, &source));
    return bits.bytes();
}

/// Tells with which of kPredictions the growth of a mesh over the coarse mesh in `state` gets shortest, by its first
/// vertices; nothing when the mesh cannot grow.
std::optional<PredictionShares> choose_predictions(GrowthSource& source, const BatchState& state)
{
    std::optional<PredictionShares> best;
    std::size_t least = 0;
    for (const PredictionShares& predicted : kPredictions)
    {
        source.restart();
        const auto bytes = measure_growth(source, state, predicted);
        if (bytes && (!best || *bytes < least))
        {
            best = predicted;
            least = *bytes;
        }
    }
    return best;
}

/// Codes the growth of a freshly started source.
Result<CodedGrowth> code_growth(
    GrowthSource& source, const BatchState& state, const PredictionShares& predicted
)
{
    BatchState grown = state;
    Growth growth(source.vertex_count(), source.face_count());
    BitEncoder head;
    VSPLIT_TRY(growth.begin(head, grown, predicted));
    CodedGrowth coded;
    GrowthShare left{source.face_count(), source.vertex_count()};
    while (left.faces > 0 || left.vertices > 0)
    {
        GrowthShare share;
        MeasuredEncoder body;
        while (body.bytes() <= kFullChunk && (left.faces > 0 || left.vertices > 0))
        {
            GrowthShare step;
            step.faces = std::min(left.faces, kStep);
            step.vertices = left.faces > 0 ? 0 : std::min(left.vertices, kStep);
            VSPLIT_TRY(growth.extend(body, grown, step, &source));
            left = {left.faces - step.faces, left.vertices - step.vertices};
            share = {share.faces + step.faces, share.vertices + step.vertices};
        }
        static_cast<void>(Growth::code_share(head, share));
        head.append(body.bits());
        ByteWriter chunk;
        head.finish(chunk);
        coded.chunks.emplace_back(chunk.view().begin(), chunk.view().end());
    }
    if (!growth.complete())
    {
        return fail(ErrorCode::Internal, "the growth does not reach the complete mesh");
    }
    coded.sources.resize(growth.numbers().size());
    for (std::uint32_t t = 0; t < coded.sources.size(); ++t)
    {
        coded.sources[growth.numbers()[t]] = source.vertex(t);
    }
    return coded;
}

}  // namespace

Result<std::optional<CodedGrowth>> try_growth(
    const GridMesh& mesh, std::span<const std::uint32_t> place, const BatchState& state
)
{
    GrowthSource source(mesh, place);
    const auto predicted = choose_predictions(source, state);
    if (!predicted)
    {
        return std::nullopt;
    }
    source.restart();
    auto coded = code_growth(source, state, *predicted);
    VSPLIT_TRY(coded);
    return std::optional<CodedGrowth>(std::move(*coded));
}

}  // namespace vsplit::codec
