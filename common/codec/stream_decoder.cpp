#include "codec/stream_decoder.h"

#include "codec/base_mesh_decoder.h"
#include "codec/batch_coder.h"
#include "codec/entropy_coder.h"
#include "codec/split_updates.h"
#include "codec/stitch_coder.h"
#include "core/assert.h"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

namespace vsplit::codec {

class StreamDecoder::Impl
{
public:
    explicit Impl(const DecodeLimits& limits) : limits_(limits) {}

    std::size_t wanted_bytes() const
    {
        const std::size_t needed = unit_bytes();
        return error_ || needed < buffer_.size() ? 0 : needed - buffer_.size();
    }

    Result<std::size_t> feed(std::span<const std::byte> bytes)
    {
        if (error_)
        {
            return tl::unexpected<Error>(*error_);
        }
        const std::size_t taken = std::min(bytes.size(), wanted_bytes());
        buffer_.insert(
            buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken)
        );
        received_ += taken;
        return taken;
    }

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
        if (buffer_.size() < unit_bytes())
        {
            return current(StepKind::NeedBytes);
        }
        auto result = info_ ? decode_chunk() : decode_header();
        if (!result)
        {
            error_ = result.error();
        }
        return result;
    }

    bool complete() const { return info_ && next_ == info_->chunks.size(); }

    std::optional<StreamInfo> info_;
    BatchState state_;
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
        if (buffer_.size() < header_probe_bytes())
        {
            return header_probe_bytes();
        }
        // A prefix that does not parse is reported by step(); ask for nothing more.
        return parse_header_bytes(buffer_, limits_).value_or(0);
    }

    Step current(StepKind kind) const
    {
        Step step;
        step.kind = kind;
        step.level = level_;
        step.vertices = state_.mesh.vertex_count();
        step.faces = state_.mesh.face_count();
        step.first_new_vertex = step.vertices;
        step.first_moved_vertex = step.vertices;
        return step;
    }

    void consume_unit()
    {
        decoded_ += buffer_.size();
        buffer_.clear();
    }

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

    /// Runs what allocates within the limits: they may allow more than there is.
    template <typename Allocate>
    static Result<void> take_memory(const Allocate& allocate)
    {
        try
        {
            allocate();
        }
        catch (const std::bad_alloc&)
        {
            return fail(ErrorCode::LimitExceeded, "there is not enough memory for the mesh");
        }
        return {};
    }

    Result<Step> decode_chunk()
    {
        const ChunkInfo& chunk = info_->chunks[next_];
        const auto contents = chunk_contents(buffer_, chunk.offset);
        VSPLIT_TRY(contents);
        Step step = current(StepKind::SkippedChunk);
        step.chunk_bytes = chunk.bytes;
        updates_.show({});
        const auto done = decode_contents(chunk, *contents, step);
        if (!done)
        {
            return fail(done.error().code, done.error().message, chunk.offset);
        }
        step.vertices = state_.mesh.vertex_count();
        step.faces = state_.mesh.face_count();
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
        if (static_cast<std::uint8_t>(chunk.kind) >= proto::kFirstOptionalChunkKind)
        {
            return {};
        }
        if (chunk.kind == proto::ChunkKind::Batch && level_ >= limits_.max_level)
        {
            return fail(ErrorCode::LimitExceeded, "the level is beyond the limit");
        }
        step.kind = StepKind::Chunk;
        step.level_complete = chunk.ends_level;
        return chunk.kind == proto::ChunkKind::Base ? decode_base(chunk, bytes, step)
                                                    : decode_batch(chunk, bytes, step);
    }

    Result<void> decode_base(const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step)
    {
        state_.shift = chunk.shift;
        const auto base = decode_base_chunk(*info_, bytes);
        VSPLIT_TRY(base);
        // Not before Draco has given its own memory back.
        VSPLIT_TRY(take_memory([&] {
            const StreamInfo info = prefix_info(*info_, limits_.max_level);
            state_.mesh.reserve(info.vertex_count, info.face_count);
            state_.splits.reserve(largest_chunk(info).splits);
        }));
        VSPLIT_TRY(state_.mesh.set_base(*base, state_.max_index()));
        updates_.show_all();
        step.first_new_vertex = 0;
        step.first_moved_vertex = 0;
        return {};
    }

    Result<void> decode_batch(const ChunkInfo& chunk, std::span<const std::byte> bytes, Step& step)
    {
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
        if (state_.mesh.vertex_count() != info_->vertex_count || state_.shift != 0)
        {
            return fail(ErrorCode::BadChunk, "a stitch chunk comes before the last level");
        }
        BitDecoder bits;
        VSPLIT_TRY(bits.start(bytes));
        stitches_.assign(info_->vertex_count, 0);
        code_stitches(
            bits, [this](std::uint32_t v) { return grid_position(v); }, stitches_
        );
        return bits.finish();
    }

    DecodeLimits limits_;
    std::vector<std::byte> buffer_;
    SplitUpdates updates_{state_.mesh};
    std::optional<Error> error_;
    std::size_t next_ = 0;

public:
    std::array<std::int32_t, 3> grid_position(std::uint32_t vertex) const
    {
        const Point& point = state_.mesh.points()[vertex];
        return {
            static_cast<std::int32_t>(point.x),
            static_cast<std::int32_t>(point.y),
            static_cast<std::int32_t>(point.z),
        };
    }
};

StreamDecoder::StreamDecoder(const DecodeLimits& limits) : impl_(std::make_unique<Impl>(limits)) {}

StreamDecoder::~StreamDecoder() = default;
StreamDecoder::StreamDecoder(StreamDecoder&&) noexcept = default;
StreamDecoder& StreamDecoder::operator=(StreamDecoder&&) noexcept = default;

Result<std::size_t> StreamDecoder::feed(std::span<const std::byte> bytes)
{
    return impl_->feed(bytes);
}

std::size_t StreamDecoder::wanted_bytes() const
{
    return impl_->wanted_bytes();
}

Result<Step> StreamDecoder::step()
{
    return impl_->step();
}

const StreamInfo* StreamDecoder::info() const
{
    return impl_->info_ ? &*impl_->info_ : nullptr;
}

std::uint64_t StreamDecoder::decoded_bytes() const
{
    return impl_->decoded_;
}

std::uint64_t StreamDecoder::received_bytes() const
{
    return impl_->received_;
}

bool StreamDecoder::complete() const
{
    return impl_->complete();
}

std::uint32_t StreamDecoder::level() const
{
    return impl_->level_;
}

std::uint32_t StreamDecoder::vertices() const
{
    return impl_->state_.mesh.vertex_count();
}

std::uint32_t StreamDecoder::faces() const
{
    return impl_->state_.mesh.face_count();
}

int StreamDecoder::shift() const
{
    return impl_->state_.shift;
}

void StreamDecoder::write_positions(std::uint32_t first, std::uint32_t count, std::span<float> out)
    const
{
    VSPLIT_ASSERT(std::uint64_t{first} + count <= vertices() && out.size() >= 3ULL * count);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const auto point =
            dequantize(impl_->info_->grid, impl_->grid_position(first + i), impl_->state_.shift);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            out[3ULL * i + axis] = static_cast<float>(point[axis]);
        }
    }
}

std::array<std::int32_t, 3> StreamDecoder::grid_position(std::uint32_t vertex) const
{
    return impl_->grid_position(vertex);
}

void StreamDecoder::write_triangles(std::span<Triangle> out) const
{
    VSPLIT_ASSERT(out.size() >= faces());
    for (const auto range : impl_->state_.mesh.face_ranges())
    {
        for (const Face& face : range)
        {
            out[face.slot] = face.vertex;
        }
    }
}

std::span<const std::uint32_t> StreamDecoder::stitches() const
{
    return complete() ? std::span<const std::uint32_t>(impl_->stitches_)
                      : std::span<const std::uint32_t>{};
}

}  // namespace vsplit::codec
