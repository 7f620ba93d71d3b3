#include "precompute/encode_mesh.h"

#include "codec/stream_encoder.h"
#include "codec/stream_header_writer.h"
#include "precompute/collapse_cost.h"
#include "precompute/collapse_sequence.h"
#include "precompute/concurrent_meter.h"
#include "precompute/cut_copies.h"
#include "precompute/half_edge_mesh.h"
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
    std::size_t batch = sequence.seams.size();
    for (std::size_t level = 0; level < views.size(); ++level)
    {
        codec::PlannedLevel planned;
        if (level > 0)
        {
            planned.batches = sequence.levels[level - 1].batches;  // the meter still reads them
            planned.parts = sequence.levels[level - 1].parts;
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

    PartSchedule parts(
        source.exact, source.quantised.triangles, source.stitches, source.importance
    );
    if (!options.level_vertices.empty())
    {
        parts.keep_all();  // or levels would not have the vertices that are asked for
    }
    ConcurrentMeter meter(
        {.exact = source.exact,
         .mesh = &source.quantised,
         .locked = source.locked,
         .bits = options.position_bits,
         .late_bits = late_bits(options),
         .components = parts.components()},
        source.importance,
        options.threads
    );
    Sequence sequence =
        make_sequence(source, options, progress, parts, [&](const LevelStep& step, bool is_level) {
            meter.take(step, is_level);
        });
    result.seconds.collapse = lap(start);

    order_levels(sequence, source);
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
    plan.late_bits = late_bits(options);
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
