#pragma once

// The inside of StreamDecoder; included by stream_decoder.cpp alone.

#include "codec/attribute_chunks.h"
#include "codec/base_mesh_decoder.h"
#include "codec/batch_coder.h"
#include "codec/entropy_coder.h"
#include "codec/growth_coder.h"
#include "codec/index_reader.h"
#include "codec/shown_mesh.h"
#include "codec/split_updates.h"
#include "codec/stitch_coder.h"
#include "codec/stream_decoder.h"
#include "codec/take_memory.h"
#include "core/assert.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace vsplit::codec {

/// State and steps of a StreamDecoder, which documents them.
class StreamDecoder::Impl
{
public:
    /// Prepares a decoder that obeys the limits.
    explicit Impl(const DecodeLimits& limits) : limits_(limits) {}

    /// As StreamDecoder::wanted_bytes().
    std::size_t wanted_bytes() const
    {
        const std::size_t needed = unit_bytes();
        return error_ || needed < filled() ? 0 : needed - filled();
    }

    /// As StreamDecoder::feed().
    Result<std::size_t> feed(std::span<const std::byte> bytes)
    {
        if (error_)
        {
            return tl::unexpected<Error>(*error_);
        }
        const std::size_t taken = std::min(bytes.size(), wanted_bytes());
        buffer_.resize(std::exchange(spent_, false) ? 0 : buffer_.size());
        buffer_.insert(
            buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken)
        );
        received_ += taken;
        return taken;
    }

    /// As StreamDecoder::step().
    Result<Step> step()
    {
        if (error_)
        {
            return tl::unexpected<Error>(*error_);
        }
        if (complete())
        {
            return current(StepKind::Complete);
        }
        if (filled() < unit_bytes())
        {
            return current(StepKind::NeedBytes);
        }
        return (info_ ? decode_chunk() : decode_header()).map_error([this](const Error& error) {
            error_ = error;
            return error;
        });
    }

    /// As StreamDecoder::complete().
    bool complete() const { return info_ && next_ == info_->chunks.size(); }

    /// The mesh that is shown now.
    ShownMesh shown() const { return {state_.mesh, grown() ? growth_.get() : nullptr}; }

    /// As StreamDecoder::attributes().
    const LevelAttributes* attributes() const
    {
        return attributes_.settled() ? attributes_.shown() : nullptr;
    }

    std::optional<StreamInfo> info_;
    BatchState state_;
    std::unique_ptr<Growth> growth_;  ///< Once its first chunk came.
    std::vector<std::uint32_t> stitches_;
    std::uint64_t decoded_ = 0;
    std::uint64_t received_ = 0;
    std::uint32_t level_ = 0;

private:
    /// Bytes of the unit that comes next: as much of the header as is known to exist, or a chunk.
    std::size_t unit_bytes() const
    {
        if (info_)
        {
            return complete() ? 0 : info_->chunks[next_].bytes;
        }
        if (filled() < header_probe_bytes())
        {
            return header_probe_bytes();
        }
        // A prefix that does not parse is reported by step(); ask for nothing more.
        return parse_header_bytes(buffer_, limits_).value_or(0);
    }

    /// True when the complete mesh has taken the place of the coarse one.
    bool grown() const { return growth_ && growth_->finished(); }

    Step current(StepKind kind) const
    {
        Step step;
        step.kind = kind;
        step.level = level_;
        step.vertices = shown().vertices();
        step.faces = shown().faces();
        step.first_new_vertex = step.vertices;
        step.first_moved_vertex = step.vertices;
        return step;
    }

    void consume_unit()
    {
        decoded_ += buffer_.size();
        spent_ = true;
    }

    std::size_t filled() const { return spent_ ? 0 : buffer_.size(); }

    Result<Step> decode_header()
    {
        auto info = parse_stream_info(buffer_, limits_);
        VSPLIT_TRY(info);
        info_ = std::move(*info);
        consume_unit();
        state_.bits = info_->grid.bits;
        const std::uint32_t longest = largest_chunk(prefix_info(*info_, limits_.max_level)).bytes;
        VSPLIT_TRY(take_memory([&] { buffer_.reserve(longest); }));
        return current(StepKind::Header);
    }

    Result<Step> decode_chunk()
    {
        const ChunkInfo& chunk = info_->chunks[next_];
        const auto contents = chunk_contents(buffer_, chunk.offset);
        VSPLIT_TRY(contents);
        Step step = current(StepKind::SkippedChunk);
        step.chunk_bytes = chunk.bytes;
        step.chunk = &chunk;
        step.contents = is_optional(chunk.kind) ? *contents : std::span<const std::byte>{};
        updates_.show({});
        auto done = decode_contents(chunk, *contents, step);
        if (done && next_ + 1 == info_->chunks.size() && !attributes_.settled())
        {
            done = fail(ErrorCode::BadChunk, "the stream ends within attributes");
        }
        if (!done)
        {
            return fail(done.error().code, done.error().message, chunk.offset);
        }
        step.vertices = shown().vertices();
        step.faces = shown().faces();
        step.triangles = TriangleUpdates(updates_);
        if (step.level_complete)
        {
            level_ = next_ == 0 ? 0 : level_ + 1;
        }
        step.level = level_;
        ++next_;
        consume_unit();
        return step;
    }

    Result<void> decode_contents(
        const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step
    )
    {
        if (chunk.kind == proto::ChunkKind::Stitch && chunk.codec == 0)
        {
            return decode_stitches(bytes);
        }
        if (chunk.kind == proto::ChunkKind::Attributes && chunk.codec <= proto::kLateBitsCodec &&
            limits_.attributes)
        {
            return decode_attributes(chunk, bytes, step);
        }
        if (is_optional(chunk.kind))
        {
            return {};
        }
        if (chunk.kind != proto::ChunkKind::Base && level_ >= limits_.max_level)
        {
            return fail(ErrorCode::LimitExceeded, "the level is beyond the limit");
        }
        if (!attributes_.settled())
        {
            return fail(ErrorCode::BadChunk, "the attributes of a level are not complete");
        }
        step.kind = StepKind::Chunk;
        step.level_complete = chunk.ends_level;
        switch (chunk.kind)
        {
            case proto::ChunkKind::Base:
                return decode_base(chunk, bytes, step);
            case proto::ChunkKind::Parts:
                return decode_parts(chunk, bytes);
            case proto::ChunkKind::Growth:
                return decode_growth(chunk, bytes, step);
            default:
                return decode_batch(chunk, bytes, step);
        }
    }

    Result<void> decode_attributes(
        const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step
    )
    {
        if (next_ == 0 || !chunk.ends_level)
        {
            return fail(ErrorCode::BadChunk, "attributes stand within a level");
        }
        const AttributedLevel at{
            .level = level_,
            .last = level_ + 1ULL == info_->levels.size(),
            .replaced = grown(),
            .copy = [this] { return shown().copy(); }};
        VSPLIT_TRY(attributes_.decode(*info_, limits_.max_level, chunk.codec, bytes, at));
        step.attributes_complete = attributes_.settled();
        return {};
    }

    Result<void> decode_growth(const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step)
    {
        if (!growth_)
        {
            state_.end_splits();
            VSPLIT_TRY(take_memory([&] {
                growth_ = std::make_unique<Growth>(info_->vertex_count, info_->face_count);
                growth_->reserve();
            }));
        }
        BitDecoder bits;
        VSPLIT_TRY(bits.start(bytes));
        VSPLIT_TRY(growth_->run(bits, state_, {}, {}, nullptr));
        VSPLIT_TRY(bits.finish());
        if (growth_->complete() != chunk.ends_level)
        {
            return fail(ErrorCode::BadChunk, "the growth ends elsewhere than the index says");
        }
        if (chunk.ends_level)
        {
            VSPLIT_TRY(growth_->finish());
            state_.mesh = RefinementMesh();
            step.first_moved_vertex = state_.shift > 0 ? 0 : step.first_moved_vertex;
            state_.shift = 0;
            step.triangles_replaced = true;
        }
        return {};
    }

    Result<void> decode_base(const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step)
    {
        state_.shift = chunk.shift;
        const auto base = decode_base_chunk(*info_, bytes);
        VSPLIT_TRY(base);
        // Not before Draco has given its own memory back.
        VSPLIT_TRY(take_memory([&] {
            const StreamInfo info = prefix_info(*info_, limits_.max_level);
            const RefinedCounts counts = refined_counts(info);
            state_.mesh.reserve(counts.vertices, counts.faces);
            state_.splits.reserve(largest_chunk(info).splits);
        }));
        VSPLIT_TRY(state_.mesh.set_base(*base, state_.max_index()));
        updates_.show_all();
        step.first_new_vertex = 0;
        step.first_moved_vertex = 0;
        return {};
    }

    /// Adds components to a complete level; the index lets none come elsewhere.
    Result<void> decode_parts(const ChunkInfo& chunk, std::span<const std::byte> bytes)
    {
        const std::uint32_t faces = state_.mesh.face_count();
        const auto parts = decode_parts_chunk(
            *info_,
            bytes,
            chunk.vertices - state_.mesh.vertex_count(),
            chunk.faces - faces,
            state_.shift
        );
        VSPLIT_TRY(parts);
        VSPLIT_TRY(state_.mesh.add_parts(*parts, state_.max_index()));
        updates_.show_from(faces);
        return {};
    }

    Result<void> decode_batch(const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step)
    {
        if (growth_)
        {
            return fail(ErrorCode::BadChunk, "splits follow a growth");
        }
        BitDecoder bits;
        VSPLIT_TRY(bits.start(bytes));
        const bool starts = info_->chunks[next_ - 1].ends_level;
        const bool batches_follow = starts || is_refining(state_);
        if (starts)
        {
            start_level(bits, state_, chunk.shift, {});
        }
        if (is_refining(state_))
        {
            step.first_moved_vertex = state_.refined;
            VSPLIT_TRY(refine_positions(bits, state_, {}));
        }
        if (is_refining(state_))
        {
            return bits.finish();
        }
        std::uint32_t batches = 1;
        if (batches_follow)
        {
            batches = bits.raw(0, kBatchCountBits) + 1;
            start_batch(state_);
        }
        // What earlier batches changed is not kept: there are so many changes that all may be told.
        const bool several = batches > 1;
        for (; batches > 1; --batches)
        {
            VSPLIT_TRY(decode_splits(bits, chunk, bits.raw(0, kSplitCountBits)));
            start_batch(state_);
        }
        VSPLIT_TRY(decode_splits(bits, chunk, chunk.vertices - state_.mesh.vertex_count()));
        VSPLIT_TRY(bits.finish());
        if (state_.mesh.face_count() != chunk.faces)
        {
            return fail(ErrorCode::BadChunk, "a chunk adds other faces than the index says");
        }
        if (several)
        {
            updates_.show_all();
        }
        return {};
    }

    /// Decodes and carries out `count` splits of a batch.
    Result<void> decode_splits(BitDecoder& bits, const ChunkInfo& chunk, std::uint32_t count)
    {
        if (count > chunk.vertices - state_.mesh.vertex_count())
        {
            return fail(ErrorCode::BadChunk, "a chunk holds more splits than the index says");
        }
        VSPLIT_TRY(code_connectivity(bits, state_, count, nullptr));
        code_weights(bits, state_, false, {});
        VSPLIT_TRY(code_positions(bits, state_, {}));
        if (RefinementMesh::added_faces(state_.splits) > chunk.faces - state_.mesh.face_count())
        {
            return fail(ErrorCode::BadChunk, "a chunk adds other faces than the index says");
        }
        updates_.show(state_.splits);
        state_.mesh.apply(state_.splits);
        return {};
    }

    Result<void> decode_stitches(std::span<const std::byte> bytes)
    {
        if (shown().vertices() != info_->vertex_count || state_.shift != 0)
        {
            return fail(ErrorCode::BadChunk, "a stitch chunk comes before the last level");
        }
        BitDecoder bits;
        VSPLIT_TRY(bits.start(bytes));
        stitches_.assign(info_->vertex_count, 0);
        code_stitches(
            bits, [mesh = shown()](std::uint32_t v) { return mesh.position(v); }, stitches_
        );
        return bits.finish();
    }

    DecodeLimits limits_;
    std::vector<std::byte> buffer_;
    SplitUpdates updates_{state_.mesh};
    std::optional<Error> error_;
    std::size_t next_ = 0;
    AttributeChunks attributes_;
    bool spent_ = false;  ///< buffer_ was decoded; it stays until more bytes come.

public:
    /// As StreamDecoder::next_chunk().
    const ChunkInfo* next_chunk() const;
    /// As StreamDecoder::skip().
    Step skip();
};

}  // namespace vsplit::codec
