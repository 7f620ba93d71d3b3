#include "codec/stream_decoder.h"

#include "codec/stream_decoder_impl.h"
#include "core/assert.h"

namespace vsplit::codec {

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

Step StreamDecoder::Impl::skip()
{
    VSPLIT_ASSERT(next_chunk() != nullptr && is_optional(next_chunk()->kind) && filled() == 0);
    Step step = current(StepKind::SkippedChunk);
    step.chunk = next_chunk();
    updates_.show({});
    if (step.chunk->kind == proto::ChunkKind::Attributes)
    {
        // Later ones build on it.
        attributes_ = {};
        limits_.attributes = false;
    }
    decoded_ += step.chunk->bytes;
    received_ += step.chunk->bytes;
    ++next_;
    return step;
}

const ChunkInfo* StreamDecoder::Impl::next_chunk() const
{
    return info_ && !complete() ? &info_->chunks[next_] : nullptr;
}

const ChunkInfo* StreamDecoder::next_chunk() const
{
    return impl_->next_chunk();
}

Step StreamDecoder::skip()
{
    return impl_->skip();
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
    return impl_->shown().vertices();
}

std::uint32_t StreamDecoder::faces() const
{
    return impl_->shown().faces();
}

int StreamDecoder::shift() const
{
    return impl_->state_.shift;
}

void StreamDecoder::write_positions(std::uint32_t first, std::uint32_t count, std::span<float> out)
    const
{
    VSPLIT_ASSERT(std::uint64_t{first} + count <= vertices() && out.size() >= 3ULL * count);
    const ShownMesh mesh = impl_->shown();
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const auto point =
            dequantize(impl_->info_->grid, mesh.position(first + i), impl_->state_.shift);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            out[3ULL * i + axis] = static_cast<float>(point[axis]);
        }
    }
}

std::array<std::int32_t, 3> StreamDecoder::grid_position(std::uint32_t vertex) const
{
    return impl_->shown().position(vertex);
}

void StreamDecoder::write_triangles(std::span<Triangle> out) const
{
    VSPLIT_ASSERT(out.size() >= faces());
    impl_->shown().write_triangles(out);
}

std::span<const std::uint32_t> StreamDecoder::stitches() const
{
    return complete() ? std::span<const std::uint32_t>(impl_->stitches_)
                      : std::span<const std::uint32_t>{};
}

const LevelAttributes* StreamDecoder::attributes() const
{
    return impl_->attributes();
}

LevelMesh StreamDecoder::level_mesh() const
{
    return impl_->shown().copy();
}

}  // namespace vsplit::codec
