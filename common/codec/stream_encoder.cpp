#include "codec/stream_encoder.h"

#include "codec/attribute_writer.h"
#include "codec/base_mesh_encoder.h"
#include "codec/batch_coder.h"
#include "codec/chunk_list.h"
#include "codec/entropy_coder.h"
#include "codec/grid_positions.h"
#include "codec/growth_planner.h"
#include "codec/level_cutter.h"
#include "codec/split_planner.h"
#include "codec/stitch_encoder.h"
#include "codec/weight_fit.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace vsplit::codec {
namespace {

/// Builds the stream chunk by chunk, keeping the mesh as the decoder will have it.
class StreamBuilder
{
public:
    StreamBuilder(const StreamPlan& plan, const std::function<void(double)>& progress)
        : plan_(plan),
          progress_(progress),
          place_(plan.mesh->positions.size(), GrowthSource::kNone),
          on_grid_(*plan.mesh),
          cutter_(static_cast<std::uint32_t>(plan.mesh->positions.size()))
    {
        for (const auto& position : plan.mesh->positions)
        {
            std::ranges::transform(extent_, position, extent_.begin(), std::ranges::max);
        }
        if (plan.training != nullptr)
        {
            *state_.model = *plan.training;
        }
    }

    Result<std::vector<std::byte>> run()
    {
        VSPLIT_TRY(add_base());
        std::optional<StreamBuilder> early;
        std::optional<StreamBuilder> late;
        const auto pays = [this](const std::optional<StreamBuilder>& grown) {
            return grown && growth_pays(grown->chunks_.bytes(), chunks_.bytes());
        };
        for (std::size_t level = 1; level < plan_.levels.size() && !pays(late); ++level)
        {
            VSPLIT_TRY(add_level(plan_.levels[level]));
            const GrowthStart start = growth_start(plan_, level, chunks_.bytes());
            if (start == GrowthStart::IfShort || start == GrowthStart::IfNeeded)
            {
                VSPLIT_TRY(grow_if_short(late));
            }
            if (start == GrowthStart::IfNeeded && !early)
            {
                VSPLIT_TRY(grow(early));
            }
            if (start == GrowthStart::Now && !late)
            {
                VSPLIT_TRY(grow(late));
            }
        }
        if (pays(late) || pays(early))
        {
            StreamBuilder& grown = pays(late) ? *late : *early;
            grown.add_stitches();
            return grown.finish();
        }
        if (state_.mesh.vertex_count() != plan_.mesh->positions.size() ||
            state_.mesh.face_count() != plan_.mesh->triangles.size() || state_.shift != 0)
        {
            return fail(ErrorCode::Internal, "the collapse sequence does not undo itself");
        }
        if (plan_.training != nullptr)
        {
            *plan_.training = *state_.model;
        }
        add_stitches();
        return finish();
    }

private:
    void add_chunk(
        proto::ChunkKind kind,
        std::span<const std::byte> bytes,
        const PlannedLevel* ends,
        std::uint8_t codec = 0
    )
    {
        ChunkInfo chunk{.kind = kind, .codec = codec};
        chunk.ends_level = ends != nullptr || kind == proto::ChunkKind::Stitch;
        chunk.vertices = grown_ ? plan_vertices() : state_.mesh.vertex_count();
        chunk.faces = grown_ ? plan_faces() : state_.mesh.face_count();
        chunk.shift = grown_ ? 0 : state_.shift;
        if (ends != nullptr)
        {
            chunk.rms_error = ends->rms_error;
            chunk.max_error = ends->max_error;
        }
        chunks_.add(chunk, bytes);
        if (progress_ && kind != proto::ChunkKind::Growth)
        {
            progress_(
                static_cast<double>(chunk.vertices) /
                static_cast<double>(plan_.mesh->positions.size())
            );
        }
    }

    /// Makes a vertex the next one of the stream.
    void place_vertex(std::uint32_t source)
    {
        place_[source] = static_cast<std::uint32_t>(source_.size());
        source_.push_back(source);
    }

    Result<void> add_base()
    {
        const PlannedLevel& level = plan_.levels.front();
        on_grid_.enter(level, true);
        const auto [base, sources] = collect_base(plan_.base_triangles, on_grid_);
        const auto encoded = encode_base_mesh(base, extent_at(level.shift));
        VSPLIT_TRY(encoded);
        for (const std::uint32_t vertex : encoded->vertices)
        {
            place_vertex(sources[vertex]);
        }
        state_.mesh.reserve(
            static_cast<std::uint32_t>(plan_.mesh->positions.size()),
            static_cast<std::uint32_t>(plan_.mesh->triangles.size())
        );
        state_.bits = plan_.grid.bits;
        state_.shift = level.shift;
        VSPLIT_TRY(state_.mesh.set_base(encoded->decoded, state_.max_index()));
        add_chunk(proto::ChunkKind::Base, encoded->bytes, &level, encoded->codec);
        return {};
    }

    std::array<std::int32_t, 3> extent_at(int shift) const
    {
        return {extent_[0] >> shift, extent_[1] >> shift, extent_[2] >> shift};
    }

    /// Adds the components of a level that has no splits, group by group.
    Result<void> add_parts(const PlannedLevel& level)
    {
        if (level.shift != state_.shift)
        {
            return fail(ErrorCode::Internal, "components come at another precision");
        }
        on_grid_.enter(level, false);
        for (const std::vector<Triangle>& group : level.parts)
        {
            const auto [mesh, sources] = collect_base(group, on_grid_);
            const EncodedBase encoded =
                encode_small_base(mesh, extent_at(level.shift), ComponentStart::LastVertex);
            if (encoded.bytes.empty())
            {
                return fail(ErrorCode::Internal, "components do not make a chunk");
            }
            for (const std::uint32_t vertex : encoded.vertices)
            {
                place_vertex(sources[vertex]);
            }
            VSPLIT_TRY(state_.mesh.add_parts(encoded.decoded, state_.max_index()));
            const bool last = &group == &level.parts.back();
            add_chunk(proto::ChunkKind::Parts, encoded.bytes, last ? &level : nullptr);
        }
        return {};
    }

    Result<void> add_level(const PlannedLevel& level)
    {
        if (!level.parts.empty())
        {
            return add_parts(level);
        }
        BitEncoder bits;
        const int shift = state_.shift;
        if (level.shift > shift)
        {
            return fail(ErrorCode::Internal, "a level takes precision back");
        }
        cutter_.cost().expect_drop(shift - level.shift);
        on_grid_.enter(level, level.shift != shift);
        const auto target = on_grid_.of(source_);
        start_level(bits, state_, level.shift, target);
        std::uint32_t refined = 0;
        while (is_refining(state_))
        {
            const std::uint32_t before = state_.refined;
            VSPLIT_TRY(refine_positions(bits, state_, target));
            refined = state_.refined - before;
            if (is_refining(state_))
            {
                finish_chunk(bits, nullptr, 0);
            }
        }
        const std::uint64_t refinement = refinement_bits(refined, shift, shift - level.shift);
        bits.raw(static_cast<std::uint32_t>(level.batches.size() - 1), kBatchCountBits);
        for (std::size_t i = 0; i + 1 < level.batches.size(); ++i)
        {
            start_batch(state_);
            const auto plan = plan_splits(state_.mesh, place_, level.batches[i]);
            VSPLIT_TRY(plan);
            const auto count = static_cast<std::uint32_t>(level.batches[i].size());
            bits.raw(count, kSplitCountBits);
            VSPLIT_TRY(add_splits(bits, level.batches[i], *plan, count));
        }
        start_batch(state_);
        return add_last_batch(bits, level, refinement);
    }

    /// Codes the last batch of a level, cut into chunks when it is large. `refinement`: bits that
    /// the level's start is expected to take in the first chunk, which therefore holds fewer splits.
    Result<void> add_last_batch(
        BitEncoder& bits, const PlannedLevel& level, std::uint64_t refinement
    )
    {
        const auto& batch = level.batches.back();
        const auto plan = plan_splits(state_.mesh, place_, batch);
        VSPLIT_TRY(plan);
        auto left = static_cast<std::uint32_t>(batch.size());
        const bool whole = level.batches.size() > 1 || !plan_.cut_levels;
        std::uint32_t chunks = whole ? 1 : cutter_.chunk_count(left, refinement, chunks_.bytes());
        for (; chunks > 0; --chunks, refinement = 0)
        {
            const std::uint32_t count =
                chunks > 1 ? cutter_.cost().next_share(left, chunks, refinement) : left;
            VSPLIT_TRY(add_splits(bits, batch, *plan, count));
            left -= count;
            finish_chunk(bits, chunks == 1 ? &level : nullptr, refinement);
        }
        return {};
    }

    /// Makes a chunk of the bits so far. `refinement`: as add_last_batch()'s.
    void finish_chunk(BitEncoder& bits, const PlannedLevel* ends, std::uint64_t refinement)
    {
        ByteWriter chunk;
        bits.finish(chunk);
        const std::uint32_t before = chunks_.last().vertices;
        add_chunk(proto::ChunkKind::Batch, chunk.view(), ends);
        cutter_.cost().observe(chunks_.last().vertices - before, chunks_.last().bytes, refinement);
    }

    Result<void> add_splits(
        BitEncoder& bits,
        std::span<const Collapse> batch,
        const SplitPlan& plan,
        std::uint32_t count
    )
    {
        VSPLIT_TRY(code_connectivity(bits, state_, count, &plan));
        std::vector<std::array<std::int32_t, 3>> positions;
        std::vector<FitSample> samples;
        const auto frames = ring_frames(state_.mesh, state_.splits);
        for (std::size_t i = 0; i < frames.size(); ++i)
        {
            const Split& split = state_.splits[i];
            const std::uint32_t source =
                plan.split_of_face[static_cast<std::size_t>(face_of(split.first))];
            const std::uint32_t removed = batch[source].removed;
            positions.push_back(on_grid_[removed]);
            place_vertex(removed);
            if (split.kind == SplitKind::Interior)
            {
                samples.push_back({frames[i], positions.back()});
            }
        }
        const auto fitted = fit_weights(samples, state_.weights);
        code_weights(bits, state_, fitted.has_value(), fitted.value_or(state_.weights));
        VSPLIT_TRY(code_positions(bits, state_, positions));
        state_.mesh.apply(state_.splits);
        return {};
    }

    std::uint32_t plan_vertices() const
    {
        return static_cast<std::uint32_t>(plan_.mesh->positions.size());
    }

    std::uint32_t plan_faces() const
    {
        return static_cast<std::uint32_t>(plan_.mesh->triangles.size());
    }

    /// Tries to grow when the prefix is half as long again as at the last try; keeps what is short.
    Result<void> grow_if_short(std::optional<StreamBuilder>& grown)
    {
        if (grown || 2 * chunks_.bytes() < 3 * tried_)
        {
            return {};
        }
        tried_ = chunks_.bytes();
        VSPLIT_TRY(grow(grown));
        if (grown && !growth_is_short(tried_, grown->chunks_.bytes() - tried_))
        {
            grown.reset();
        }
        return {};
    }

    /// Makes a copy of this stream that goes on with the growth of the complete mesh; nothing when the
    /// mesh cannot grow.
    Result<void> grow(std::optional<StreamBuilder>& grown) const
    {
        const auto coded = try_growth(*plan_.mesh, place_, state_);
        VSPLIT_TRY(coded);
        if (!coded->has_value())
        {
            return {};
        }
        grown.emplace(*this);
        grown->add_growth(**coded);
        return {};
    }

    /// Ends the stream with the complete mesh, grown over the present level.
    void add_growth(const CodedGrowth& growth)
    {
        for (std::uint32_t v = state_.mesh.vertex_count(); v < growth.sources.size(); ++v)
        {
            place_vertex(growth.sources[v]);
        }
        for (std::size_t i = 0; i < growth.chunks.size(); ++i)
        {
            grown_ = i + 1 == growth.chunks.size();
            add_chunk(
                proto::ChunkKind::Growth, growth.chunks[i], grown_ ? &plan_.levels.back() : nullptr
            );
        }
    }

    void add_stitches()
    {
        if (!plan_.stitches.empty())
        {
            add_chunk(
                proto::ChunkKind::Stitch,
                encode_stitches(plan_.stitches, source_, plan_.mesh->positions),
                nullptr
            );
        }
    }

    /// The stream with all that lies on its meshes.
    Result<std::vector<std::byte>> finish()
    {
        std::vector<std::byte> file = assemble();
        if (plan_.wedges.empty())
        {
            return file;
        }
        const auto attributes = code_attributes(file, plan_, source_);
        VSPLIT_TRY(attributes);
        return insert_chunks(file, *attributes);
    }

    std::vector<std::byte> assemble()
    {
        StreamInfo info;
        info.grid = plan_.grid;
        info.vertex_count = plan_vertices();
        info.face_count = plan_faces();
        info.attributes = plan_.attributes;
        info.wedge_count = count_wedges(plan_.wedges);
        return chunks_.assemble(std::move(info), extent_);
    }

    const StreamPlan& plan_;
    const std::function<void(double)>& progress_;
    BatchState state_;
    std::vector<std::uint32_t> place_;   ///< By vertex of the plan its index in the stream.
    std::vector<std::uint32_t> source_;  ///< By vertex of the stream its index in the plan.
    GridPositions on_grid_;
    ChunkList chunks_;
    std::array<std::int32_t, 3> extent_{};  ///< Largest index per axis.
    LevelCutter cutter_;
    bool grown_ = false;     ///< The complete mesh was grown.
    std::size_t tried_ = 0;  ///< Bytes of the prefix when growing was tried last.
};

}  // namespace

Result<std::vector<std::byte>> encode_stream(
    const StreamPlan& plan, const std::function<void(double)>& progress
)
{
    return StreamBuilder(plan, progress).run();
}

}  // namespace vsplit::codec
