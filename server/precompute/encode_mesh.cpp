#include "precompute/encode_mesh.h"

#include "codec/stream_encoder.h"
#include "codec/stream_header_writer.h"
#include "precompute/collapse_cost.h"
#include "precompute/collapse_mesh.h"
#include "precompute/concurrent_meter.h"
#include "precompute/cut_copies.h"
#include "precompute/half_edge_mesh.h"
#include "precompute/level_builder.h"
#include "precompute/level_errors.h"
#include "precompute/level_schedule.h"
#include "precompute/mesh_order.h"
#include "precompute/validate.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

namespace vsplit::precompute {
namespace {

using Clock = std::chrono::steady_clock;

/// Seconds since `start`, which moves to now.
double lap(Clock::time_point& start)
{
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start).count();
    start = now;
    return seconds;
}

/// Levels that make less progress than this end the sequence, unless there are but a few vertices.
constexpr double kLeastShare = 0.02;
constexpr std::size_t kFewVertices = 400;

/// Splits that a level has at most when it joins several batches.
constexpr std::size_t kSmallestLevel = 30;

/// What is encoded, in an order in which neighbours are near in memory.
struct Source
{
    QuantizationGrid grid;
    GridMesh quantised;
    std::vector<Vector3> exact;  ///< Positions in grid units, not rounded.
    std::vector<std::uint32_t> stitches;
    std::vector<std::uint8_t> locked;  ///< Copies of cut vertices: always at home; or empty.
    std::vector<float> importance;
    std::vector<float> weights;         ///< What the metric needs.
    std::vector<Triangle> wedges;       ///< By triangle those at its corners; or empty.
    std::vector<std::uint32_t> groups;  ///< By triangle; or empty.
    std::vector<codec::AttributeInfo> attributes;
    std::vector<std::vector<std::int32_t>> values;  ///< By attribute and wedge.
};

/// The collapse sequence.
struct Sequence
{
    std::vector<LevelBatches> levels;
    std::vector<std::uint8_t> starts;  ///< By batch 1 when it may not join the level before it.
    std::vector<std::vector<codec::SeamRecord>> seams;  ///< By batch, if there are wedges.
    std::vector<Triangle> base;                         ///< The triangles that it leaves.
    std::vector<Triangle> base_wedges;
    std::vector<std::uint32_t> base_faces;
};

/// Called with every batch as soon as it is known.
using BatchSink = std::function<void(const std::vector<codec::Collapse>&)>;

Sequence make_sequence(
    Source& source,
    const EncodeOptions& options,
    const ProgressSink& progress,
    const BatchSink& take_batch
)
{
    const auto vertex_count = static_cast<std::uint32_t>(source.exact.size());
    CollapseMesh working(vertex_count, source.quantised.triangles, source.wedges);
    CollapseCost cost(
        options.metric, source.exact, working, std::move(source.weights), source.importance
    );
    LevelBuilder builder(working, cost, source.exact, {}, options.threads);
    builder.fold_together(source.stitches);
    const std::size_t base = next_stop(options, 0, vertex_count);
    Sequence sequence;
    bool choosy = true;
    while (builder.vertex_count() > base)
    {
        const std::size_t before = builder.vertex_count();
        const std::size_t stop = next_stop(options, before, vertex_count);
        LevelStyle style = style_for(options.metric, before, vertex_count);
        style.cheapest_share = choosy ? style.cheapest_share : 1.0;
        auto level = builder.next_level(style, before - stop);
        const bool arrived = before - level.size() == stop;
        const double least =
            before > kFewVertices ? kLeastShare * static_cast<double>(before) : 1.0;
        const bool slow = !arrived && static_cast<double>(level.size()) < least;
        if (!level.empty())
        {
            take_batch(level);
            sequence.levels.push_back({std::move(level)});
            sequence.starts.push_back(arrived ? 1 : 0);
            sequence.seams.push_back(builder.take_seams());
        }
        if (progress)
        {
            progress("collapse", 1.0 - static_cast<double>(builder.vertex_count()) / vertex_count);
        }
        if (slow && !choosy)
        {
            break;
        }
        // Where topology holds the cheap ones back, others must do.
        choosy = choosy && !slow;
    }
    sequence.base = working.triangles();
    if (working.has_wedges())
    {
        sequence.base_wedges = working.wedges();
        sequence.base_faces = working.faces();
    }
    return sequence;
}

/// Turns a sequence round, coarsest first, and joins small batches into one level until it is worth
/// its own chunk.
void order_levels(Sequence& sequence)
{
    std::vector<LevelBatches> joined;
    std::size_t splits = kSmallestLevel;
    for (std::size_t i = sequence.levels.size(); i-- > 0;)
    {
        auto& batch = sequence.levels[i].front();
        if (splits + batch.size() > kSmallestLevel || sequence.starts[i] != 0 ||
            joined.back().size() == codec::kMaxBatches)
        {
            splits = 0;
            joined.emplace_back();
        }
        splits += batch.size();
        joined.back().push_back(std::move(batch));
    }
    sequence.levels = std::move(joined);
}

codec::StreamPlan make_plan(
    Sequence& sequence, const Source& source, std::span<const LevelView> views
)
{
    codec::StreamPlan plan;
    plan.grid = source.grid;
    plan.mesh = &source.quantised;
    plan.base_triangles = std::move(sequence.base);
    plan.stitches = source.stitches;
    plan.wedges = source.wedges;
    plan.groups = source.groups;
    plan.attributes = source.attributes;
    plan.values = source.values;
    plan.base_wedges = std::move(sequence.base_wedges);
    plan.base_faces = std::move(sequence.base_faces);
    std::size_t batch = sequence.seams.size();
    for (std::size_t level = 0; level < views.size(); ++level)
    {
        codec::PlannedLevel planned;
        if (level > 0)
        {
            planned.batches = sequence.levels[level - 1];  // the meter still reads them
            for (std::size_t i = 0; i < planned.batches.size() && !source.wedges.empty(); ++i)
            {
                planned.seams.push_back(std::move(sequence.seams[--batch]));
            }
        }
        planned.shift = views[level].shift;
        planned.displaced = views[level].displaced;
        plan.levels.push_back(std::move(planned));
    }
    return plan;
}

/// Refuses what no stream can hold and what is no mesh.
Result<void> check_size(const IndexedMesh& mesh)
{
    if (mesh.triangles.empty() || mesh.positions.size() < 3)
    {
        return fail(ErrorCode::EmptyMesh, "there is no triangle to encode");
    }
    if (mesh.positions.size() > proto::kMaxVertices || mesh.triangles.size() > proto::kMaxFaces)
    {
        return fail(
            ErrorCode::InputTooLarge, "the mesh has more vertices or faces than a stream can hold"
        );
    }
    for (const auto& [a, b, c] : mesh.triangles)
    {
        if (std::max({a, b, c}) >= mesh.positions.size())
        {
            return fail(ErrorCode::BadIndex, "a face refers to a vertex that does not exist");
        }
    }
    return {};
}

/// Finds what the metric needs. The half-edge mesh goes when this ends, before the stages that take the
/// most memory.
Result<std::vector<float>> find_weights(const IndexedMesh& mesh, const EncodeOptions& options)
{
    const auto linked = make_half_edge_mesh(mesh);
    VSPLIT_TRY(linked);
    return vertex_weights(*linked, options.metric, options.threads);
}

/// Checks a mesh and puts it in order.
Result<Source> prepare(
    const IndexedMesh& mesh, std::span<const std::uint32_t> stitches, const EncodeOptions& options
)
{
    VSPLIT_TRY(check_size(mesh));
    const auto order = locality_order(mesh.positions);
    const IndexedMesh ordered = in_order(mesh, order);
    Source source;
    auto weights = find_weights(ordered, options);
    if (!weights)
    {
        VSPLIT_TRY(check_manifold(mesh));  // names vertices and faces as the caller knows them
        return tl::unexpected<Error>(weights.error());
    }
    source.weights = std::move(*weights);
    source.importance = in_order(std::span(options.importance), order);
    source.stitches = in_order(stitches, order);
    const auto place = inverse_order(order);
    for (std::uint32_t& vertex : source.stitches)
    {
        vertex = place[vertex];
    }
    source.locked = mark_copies(source.stitches);
    source.grid = make_grid(ordered.positions, options.position_bits);
    source.quantised = quantize(source.grid, ordered);
    source.exact.resize(ordered.positions.size());
    std::ranges::transform(ordered.positions, source.exact.begin(), [&](const auto& point) {
        return (point - source.grid.origin) * (1.0 / source.grid.cell);
    });
    return source;
}

/// Puts the errors into a finished stream.
Result<std::vector<std::byte>> with_errors(
    std::span<const std::byte> file, std::span<const SurfaceDistance> distances, double cell
)
{
    std::vector<codec::LevelErrors> errors;
    for (const SurfaceDistance& distance : distances)
    {
        errors.push_back({distance.rms * cell, distance.max * cell});
    }
    // Where the complete mesh is grown, its level follows an earlier one.
    const auto info = codec::parse_stream_info(file);
    VSPLIT_TRY(info);
    if (info->levels.size() < errors.size())
    {
        errors[info->levels.size() - 1] = errors.back();
        errors.resize(info->levels.size());
    }
    return codec::replace_errors(file, errors);
}

/// Ties the share done to the name of its stage.
std::function<void(double)> stage_progress(const ProgressSink& progress, std::string_view stage)
{
    return [&progress, stage](double share) {
        if (progress)
        {
            progress(stage, share);
        }
    };
}

/// Encodes a mesh that is in order. `begin`: when the work on it began.
Result<EncodedMesh> encode_source(
    Source& source,
    const EncodeOptions& options,
    const ProgressSink& progress,
    Clock::time_point begin
)
{
    auto start = begin;
    EncodedMesh result;
    result.seconds.metric = lap(start);

    ConcurrentMeter meter(
        {.exact = source.exact,
         .mesh = &source.quantised,
         .locked = source.locked,
         .bits = options.position_bits},
        source.importance,
        options.threads
    );
    Sequence sequence = make_sequence(source, options, progress, [&](const auto& batch) {
        meter.take(
            batch, batch.size() > kSmallestLevel
        );  // others may be joined, see order_levels()
    });
    result.seconds.collapse = lap(start);

    order_levels(sequence);
    const auto measured = stage_progress(progress, "measure");
    measured(0.0);
    const auto views = meter.choose(sequence.levels);
    measured(0.5);
    meter.start_measuring(sequence.levels, views);
    measured(1.0);
    result.seconds.distance = lap(start);

    auto plan = make_plan(sequence, source, views);
    plan.training = options.training;
    plan.grow_last_level = options.grow_last_level && options.level_vertices.empty();
    plan.cut_levels = options.cut_levels;
    auto file = codec::encode_stream(plan, stage_progress(progress, "code"));
    VSPLIT_TRY(file);
    file = with_errors(*file, meter.result(), source.grid.cell);
    VSPLIT_TRY(file);
    result.file = std::move(*file);
    auto info = codec::parse_stream_info(result.file);
    VSPLIT_TRY(info);
    result.info = std::move(*info);
    result.seconds.code = lap(start);
    result.seconds.total = std::chrono::duration<double>(Clock::now() - begin).count();
    return result;
}

/// Brings what is known of the faces into the order that prepare() brings them.
Result<void> prepare_faces(const EncodeInput& input, Source& source)
{
    const std::size_t faces = input.mesh.triangles.size();
    const bool fits = (input.wedges.empty() || input.wedges.size() == faces) &&
                      (input.groups.empty() || input.groups.size() == faces);
    if (!fits)
    {
        return fail(ErrorCode::UnsupportedInput, "wedges or groups are not those of the faces");
    }
    if (!input.wedges.empty() || !input.groups.empty())
    {
        const auto order =
            triangle_order(input.mesh.triangles, locality_order(input.mesh.positions));
        source.wedges = in_order(std::span<const Triangle>(input.wedges), order);
        source.groups = in_order(std::span<const std::uint32_t>(input.groups), order);
        source.attributes = input.attributes;
        source.values = input.values;
    }
    return {};
}

}  // namespace

Result<EncodedMesh> encode_mesh(
    const IndexedMesh& mesh,
    std::span<const std::uint32_t> stitches,
    const EncodeOptions& options,
    const ProgressSink& progress
)
{
    const auto begin = Clock::now();
    auto source = prepare(mesh, stitches, options);
    VSPLIT_TRY(source);
    return encode_source(*source, options, progress, begin);
}

Result<EncodedMesh> encode_mesh(
    IndexedMesh&& mesh,
    std::span<const std::uint32_t> stitches,
    const EncodeOptions& options,
    const ProgressSink& progress
)
{
    const auto begin = Clock::now();
    auto source = prepare(mesh, stitches, options);
    VSPLIT_TRY(source);
    mesh = {};
    return encode_source(*source, options, progress, begin);
}

Result<EncodedMesh> encode_surface(
    EncodeInput&& input, const EncodeOptions& options, const ProgressSink& progress
)
{
    const auto begin = Clock::now();
    auto source = prepare(input.mesh, input.stitches, options);
    VSPLIT_TRY(source);
    VSPLIT_TRY(prepare_faces(input, *source));
    input = {};
    return encode_source(*source, options, progress, begin);
}

}  // namespace vsplit::precompute
