#pragma once

// Based on: Pajarola, Rossignac, "Compressed Progressive Meshes", 2000. Encoder and decoder run this
// same code; only the bit coder and the plan differ.

#include "codec/connectivity_coder.h"
#include "codec/geometry_coder.h"
#include "codec/initial_model.h"
#include "codec/refinement_coder.h"
#include "codec/refinement_mesh.h"
#include "codec/split_cost.h"
#include "core/boxed.h"
#include "core/result.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Everything that lasts from chunk to chunk while a stream is coded.
struct BatchState
{
    RefinementMesh mesh;
    Boxed<LearnedModel> model{initial_model()};
    PredictionWeights weights = kInitialWeights;
    LearningRates rates;
    std::vector<Split> splits;     ///< Of the current chunk.
    std::uint32_t batch = 0;       ///< Batches started.
    int shift = 0;                 ///< Bits of precision that positions lack.
    int bits = 12;                 ///< Position bits of the full grid.
    std::int32_t cursor = 0;       ///< Next face to ask.
    std::int32_t batch_faces = 0;  ///< Faces when the batch started.
    int steps = 0;                 ///< Bits of precision that the level's start still adds.
    bool moving = false;           ///< Whether it may take vertices out of their cells.
    std::uint32_t refined = 0;     ///< Vertices that have these bits.

    /// Gives memory back that only splits need. No chunk of splits may follow.
    void end_splits()
    {
        model.release();
        splits = {};
    }

    /// Largest coordinate on the current grid.
    [[nodiscard]] std::int32_t max_index() const { return ((1 << bits) - 1) >> shift; }
};

/// Bits of the field that tells how many batches a level has, less one.
inline constexpr int kBatchCountBits = 3;

/// Most batches of a level.
inline constexpr std::size_t kMaxBatches = std::size_t{1} << kBatchCountBits;

/// Bits of the field that tells how many splits a batch has, unless it is the chunk's last one.
inline constexpr int kSplitCountBits = 12;

/// Says whether a target lies outside of the cell that its vertex is in; false in a decoder.
template <typename Coder>
[[nodiscard]] bool leaves_cells(
    const Coder& /*coder*/,
    const BatchState& state,
    int steps,
    std::span<const std::array<std::int32_t, 3>> target
)
{
    if constexpr (Coder::kEncodes)
    {
        for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
        {
            const Point& point = state.mesh.points()[v];
            if (target[v][0] >> steps != static_cast<std::int32_t>(point.x) ||
                target[v][1] >> steps != static_cast<std::int32_t>(point.y) ||
                target[v][2] >> steps != static_cast<std::int32_t>(point.z))
            {
                return true;
            }
        }
    }
    return false;
}

/// Starts a level of shift `shift`, at most that of the level before: every vertex goes to the middle of
/// the cell that it was in. `target`: positions by vertex on the level's grid, encoder only.
template <typename Coder>
void start_level(
    Coder& coder, BatchState& state, int shift, std::span<const std::array<std::int32_t, 3>> target
)
{
    state.steps = state.shift - shift;
    state.refined = 0;
    if (state.steps == 0)
    {
        return;
    }
    state.moving = coder.raw(leaves_cells(coder, state, state.steps, target) ? 1U : 0U, 1) != 0;
    state.shift = shift;
    const auto scale = static_cast<float>(std::int32_t{1} << state.steps);
    for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
    {
        Point& point = state.mesh.points()[v];
        point.x = (point.x + 0.5F) * scale;
        point.y = (point.y + 0.5F) * scale;
        point.z = (point.z + 0.5F) * scale;
    }
}

/// Says whether vertices still lack the bits that the level's start adds.
[[nodiscard]] inline bool is_refining(const BatchState& state)
{
    return state.steps > 0;
}

/// Codes what the next refined_per_chunk() vertices add to their positions. `target`: as start_level()'s.
/// Error: BadChunk when a vertex leaves the grid. Safe on untrusted input.
template <typename Coder>
[[nodiscard]] Result<void> refine_positions(
    Coder& coder, BatchState& state, std::span<const std::array<std::int32_t, 3>> target
)
{
    Point* const points = state.mesh.points();
    const std::int32_t half = std::int32_t{1} << (state.steps - 1);
    const std::int32_t most = state.max_index();
    const std::uint32_t left_over = state.mesh.vertex_count() - state.refined;
    const std::uint32_t end = state.refined + std::min(left_over, refined_per_chunk(state.steps));
    for (; state.refined < end; ++state.refined)
    {
        const std::uint32_t v = state.refined;
        std::array<float, 3> position{points[v].x, points[v].y, points[v].z};
        std::size_t left = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int32_t corner = static_cast<std::int32_t>(position[axis]) - half;
            std::int32_t added = 0;
            if constexpr (Coder::kEncodes)
            {
                added = target[v][axis] - corner;
                if (!is_in_reach(added, state.steps))
                {
                    return fail(ErrorCode::Internal, "a vertex is too far from where it was");
                }
            }
            added = state.moving
                        ? code_step(coder, state.model->refinement, added, state.steps, left)
                        : static_cast<std::int32_t>(
                              coder.raw(static_cast<std::uint32_t>(added), state.steps)
                          );
            if (corner + added < 0 || corner + added > most)
            {
                return fail(ErrorCode::BadChunk, "a vertex leaves the grid");
            }
            position[axis] = static_cast<float>(corner + added);
        }
        points[v] = Point{position[0], position[1], position[2]};
    }
    state.steps = end == state.mesh.vertex_count() ? 0 : state.steps;
    return {};
}

/// Starts a batch: measures the edges and frees every face.
inline void start_batch(BatchState& state)
{
    state.mesh.start_batch();
    ++state.batch;
    state.rates = LearningRates::of_batch(state.batch);
    state.cursor = 0;
    state.batch_faces = static_cast<std::int32_t>(state.mesh.face_count());
}

/// Codes where the next `count` splits of the batch are; they are in state.splits afterwards.
/// Error: BadChunk when the batch has no room for so many. Safe on untrusted input.
template <typename Coder>
[[nodiscard]] Result<void> code_connectivity(
    Coder& coder, BatchState& state, std::uint32_t count, const SplitPlan* plan
)
{
    state.splits.clear();
    ConnectivityCoder<Coder> connectivity(
        state.mesh, state.model->connectivity, coder, state.rates, plan
    );
    if (!connectivity.run(state.cursor, state.batch_faces, count, state.splits))
    {
        return fail(ErrorCode::BadChunk, "a chunk announces more splits than it holds");
    }
    return {};
}

/// Codes whether the chunk changes the prediction weights, and to what.
template <typename Coder>
void code_weights(Coder& coder, BatchState& state, bool changed, const PredictionWeights& weights)
{
    if (coder.raw(changed ? 1U : 0U, 1) == 0)
    {
        return;
    }
    for (std::size_t i = 0; i < weights.size(); ++i)
    {
        state.weights[i] =
            static_cast<std::int8_t>(coder.raw(static_cast<std::uint8_t>(weights[i]), 8));
    }
}

/// Asks the memory for what the split a few places further will need.
inline void prefetch_ring(const RefinementMesh& mesh, const Split& split)
{
    const Face& face = mesh.faces()[face_of(split.first)];
    for (std::size_t k = 0; k < 3; ++k)
    {
        __builtin_prefetch(&mesh.points()[face.vertex[k]]);
        __builtin_prefetch(&mesh.faces()[face_of(face.opposite[k])]);
    }
}

/// Codes the positions of the removed vertices of state.splits; they are in place behind the known
/// vertices afterwards. `actual`: position of the i-th split on the current grid, encoder only.
/// Error: BadChunk when a position leaves the grid. Safe on untrusted input.
template <typename Coder>
[[nodiscard]] Result<void> code_positions(
    Coder& coder, BatchState& state, std::span<const std::array<std::int32_t, 3>> actual
)
{
    Point* const next = state.mesh.points() + state.mesh.vertex_count();
    const std::int32_t most = state.max_index();
    const std::span<const Split> splits = state.splits;
    RingFrames frames;
    for (std::size_t i = 0; i < splits.size(); ++i)
    {
        const std::size_t place = i % RingFrames::kMost;
        if (place == 0)
        {
            const auto rest = splits.subspan(i);
            frames.compute(state.mesh, rest.first(std::min(RingFrames::kMost, rest.size())));
            frames.predict(state.weights);
        }
        if (i + RingFrames::kMost < splits.size())
        {
            prefetch_ring(state.mesh, splits[i + RingFrames::kMost]);
        }
        std::array<std::int32_t, 3> wanted{};
        if constexpr (Coder::kEncodes)
        {
            wanted = actual[i];
        }
        const auto position = code_position(
            coder,
            state.model->geometry,
            frames.prediction(place),
            splits[i].kind != SplitKind::Interior,
            wanted
        );
        for (const std::int32_t coordinate : position)
        {
            if (coordinate < 0 || coordinate > most)
            {
                return fail(ErrorCode::BadChunk, "a vertex lies outside the grid");
            }
        }
        next[i] = Point{
            static_cast<float>(position[0]),
            static_cast<float>(position[1]),
            static_cast<float>(position[2]),
        };
    }
    return {};
}

}  // namespace vsplit::codec
