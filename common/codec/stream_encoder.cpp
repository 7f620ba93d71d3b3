#include "codec/stream_encoder.h"

#include "codec/attribute_writer.h"
#include "codec/base_mesh_encoder.h"
#include "codec/batch_coder.h"
#include "codec/entropy_coder.h"
#include "codec/grid_positions.h"
#include "codec/growth_planner.h"
#include "codec/index_coder.h"
#include "codec/split_planner.h"
#include "codec/stitch_coder.h"
#include "codec/stream_header_writer.h"
#include "codec/weight_fit.h"
#include "core/crc32c.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace vsplit::codec {
namespace {

constexpr std::uint32_t kNoVertex = 0xFFFFFFFF;

/// What header and index of a small stream take.
constexpr std::size_t kHeaderBytes = 90;

/// A chunk costs about seven bytes of its own; where the prefix is long, shorter ones bring nothing.
constexpr std::size_t kSmallestChunkBytes = 700;

/// Length to cut for when a level is long: estimates are off by less than what is left to the target.
constexpr std::size_t kFullChunkBytes = proto::kTargetChunkBytes * 5ULL / 8;

/// Vertices for each chunk that levels may be cut into beyond the first: half a percent of the file.
constexpr std::uint32_t kVerticesPerCut = 600;

/// Builds the stream chunk by chunk, keeping the mesh as the decoder will have it.
class StreamBuilder
{
public:
    StreamBuilder(const StreamPlan& plan, const std::function<void(double)>& progress)
        : plan_(plan),
          progress_(progress),
          place_(plan.mesh->positions.size(), kNoVertex),
          on_grid_(*plan.mesh)
    {
        for (const auto& position : plan.mesh->positions)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                extent_[axis] = std::max(extent_[axis], position[axis]);
            }
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
            return grown && growth_pays(grown->payload_.size(), payload_.size());
        };
        for (std::size_t level = 1; level < plan_.levels.size() && !pays(late); ++level)
        {
            VSPLIT_TRY(add_level(plan_.levels[level]));
            const GrowthStart start = start_of_growth(level);
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
        proto::ChunkKind kind, std::span<const std::byte> bytes, const PlannedLevel* ends
    )
    {
        ChunkInfo chunk;
        chunk.kind = kind;
        chunk.ends_level = ends != nullptr || kind == proto::ChunkKind::Stitch;
        chunk.bytes = static_cast<std::uint32_t>(bytes.size()) + proto::kChunkChecksumBytes;
        chunk.vertices = grown_ ? plan_vertices() : state_.mesh.vertex_count();
        chunk.faces = grown_ ? plan_faces() : state_.mesh.face_count();
        chunk.shift = grown_ ? 0 : state_.shift;
        if (ends != nullptr)
        {
            chunk.rms_error = ends->rms_error;
            chunk.max_error = ends->max_error;
        }
        chunks_.push_back(chunk);
        payload_.write_bytes(bytes);
        payload_.write(crc32c(bytes));
        content_checksum_ =
            crc32c(payload_.view().last(proto::kChunkChecksumBytes), content_checksum_);
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
        std::array<std::int32_t, 3> extent = extent_;
        for (std::int32_t& index : extent)
        {
            index >>= level.shift;
        }
        const auto encoded = encode_base_mesh(base, extent);
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
        add_chunk(proto::ChunkKind::Base, encoded->bytes, &level);
        chunks_.back().codec = encoded->codec;
        return {};
    }

    Result<void> add_level(const PlannedLevel& level)
    {
        BitEncoder bits;
        const int shift = state_.shift;
        if (level.shift > shift)
        {
            return fail(ErrorCode::Internal, "a level takes precision back");
        }
        cost_.expect_drop(shift - level.shift);
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
        std::uint32_t chunks = whole ? 1 : chunk_count(left, refinement);
        for (; chunks > 0; --chunks, refinement = 0)
        {
            const std::uint32_t count =
                chunks > 1 ? cost_.next_share(left, chunks, refinement) : left;
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
        const std::uint32_t before = chunks_.back().vertices;
        add_chunk(proto::ChunkKind::Batch, chunk.view(), ends);
        cost_.observe(chunks_.back().vertices - before, chunks_.back().bytes, refinement);
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

    /// Chunks to cut a level into: each may grow the prefix by a sixth while that is short, by a twelfth
    /// later, as long as that does not cost too much; cut for the target they are in any case.
    std::uint32_t chunk_count(std::uint32_t splits, std::uint64_t refinement)
    {
        const std::size_t prefix = kHeaderBytes + payload_.size();
        const std::size_t most = std::clamp<std::size_t>(
            prefix / 12, std::min(prefix / 6, kSmallestChunkBytes), kFullChunkBytes
        );
        const std::uint64_t bytes = (cost_.bits_for(splits) + refinement) / 8;
        const auto cuts_to = [bytes](std::size_t length) {
            return static_cast<std::uint32_t>(std::max<std::uint64_t>(bytes / length, 1) - 1);
        };
        const std::uint32_t left = plan_vertices() / kVerticesPerCut - cuts_;
        const auto cuts = std::max(cuts_to(kFullChunkBytes), std::min(cuts_to(most), left));
        cuts_ += std::min(cuts, left);
        return cuts + 1;
    }

    std::uint32_t plan_vertices() const
    {
        return static_cast<std::uint32_t>(plan_.mesh->positions.size());
    }

    std::uint32_t plan_faces() const
    {
        return static_cast<std::uint32_t>(plan_.mesh->triangles.size());
    }

    GrowthStart start_of_growth(std::size_t level) const
    {
        const bool may = plan_.grow_last_level && plan_.training == nullptr;
        return may && level + 1 < plan_.levels.size() ? growth_start(
                                                            payload_.size(),
                                                            plan_vertices(),
                                                            plan_.levels[level].shift,
                                                            !plan_.wedges.empty()
                                                        )
                                                      : GrowthStart::Never;
    }

    /// Makes a copy of this stream that goes on with the growth of the complete mesh; nothing when the
    /// mesh cannot grow.
    Result<void> grow(std::optional<StreamBuilder>& grown) const
    {
        GrowthSource source(*plan_.mesh, place_);
        const auto predicted = choose_predictions(source, state_);
        if (!predicted)
        {
            return {};
        }
        source.restart();
        const auto coded = code_growth(source, state_, *predicted);
        VSPLIT_TRY(coded);
        grown.emplace(*this);
        grown->add_growth(*coded);
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
        if (plan_.stitches.empty())
        {
            return;
        }
        // By class of the plan the first vertex of the stream that belongs to it.
        std::vector<std::uint32_t> first(source_.size(), kNoVertex);
        std::vector<std::uint32_t> stitches(source_.size());
        for (std::uint32_t v = 0; v < source_.size(); ++v)
        {
            std::uint32_t& representative = first[plan_.stitches[source_[v]]];
            representative = std::min(representative, v);
            stitches[v] = representative;
        }
        BitEncoder bits;
        code_stitches(
            bits, [this](std::uint32_t v) { return plan_.mesh->positions[source_[v]]; }, stitches
        );
        ByteWriter chunk;
        bits.finish(chunk);
        add_chunk(proto::ChunkKind::Stitch, chunk.view(), nullptr);
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
        info.chunks = std::move(chunks_);
        info.content_checksum = content_checksum_;
        info.attributes = plan_.attributes;
        info.wedge_count = count_wedges(plan_.wedges);
        std::vector<std::byte> file = write_stream_header(info, extent_);
        const auto payload = payload_.view();
        file.insert(file.end(), payload.begin(), payload.end());
        return file;
    }

    const StreamPlan& plan_;
    const std::function<void(double)>& progress_;
    BatchState state_;
    std::vector<std::uint32_t> place_;   ///< By vertex of the plan its index in the stream.
    std::vector<std::uint32_t> source_;  ///< By vertex of the stream its index in the plan.
    GridPositions on_grid_;
    std::vector<ChunkInfo> chunks_;
    ByteWriter payload_;
    std::uint32_t content_checksum_ = 0;
    std::array<std::int32_t, 3> extent_{};  ///< Largest index per axis.
    SplitCost cost_;
    std::uint32_t cuts_ = 0;  ///< Of levels into chunks so far.
    bool grown_ = false;      ///< The complete mesh was grown.
};

}  // namespace

Result<std::vector<std::byte>> encode_stream(
    const StreamPlan& plan, const std::function<void(double)>& progress
)
{
    return StreamBuilder(plan, progress).run();
}

}  // namespace vsplit::codec
