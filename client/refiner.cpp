#include "refiner.h"

#include <algorithm>
#include <array>
#include <vector>

namespace vsplit::client {
namespace {

bool is_required(const codec::ChunkInfo& chunk)
{
    return static_cast<std::uint8_t>(chunk.kind) < proto::kFirstOptionalChunkKind;
}

bool is_appearance(const codec::ChunkInfo& chunk)
{
    return chunk.kind == proto::ChunkKind::Appearance || chunk.kind == proto::ChunkKind::Texture;
}

}  // namespace

void ChunkBytes::add(proto::ChunkKind kind, std::uint64_t bytes)
{
    switch (kind)
    {
        case proto::ChunkKind::Attributes:
            attributes += bytes;
            break;
        case proto::ChunkKind::Appearance:
        case proto::ChunkKind::Texture:
            textures += bytes;
            break;
        default:
            geometry += bytes;
    }
}

ChunkBytes& ChunkBytes::operator+=(const ChunkBytes& other)
{
    geometry += other.geometry;
    attributes += other.attributes;
    textures += other.textures;
    return *this;
}

bool has_surface(const codec::StreamInfo& info)
{
    return !info.attributes.empty() ||
           std::ranges::any_of(info.chunks, [](const codec::ChunkInfo& chunk) {
               return chunk.kind == proto::ChunkKind::Attributes || is_appearance(chunk);
           });
}

Refiner::Refiner(const codec::StreamInfo& info, const codec::DecodeLimits& limits, bool attributes)
    : decoder_(limits),
      buffers_(info.diagonal()),
      positions_([this](std::uint32_t first, std::uint32_t count, std::span<float> out) {
          decoder_.write_positions(first, count, out);
      }),
      triangles_([this](std::span<Triangle> out) { decoder_.write_triangles(out); }),
      attributes_(attributes && has_surface(info))
{
    if (!attributes_)
    {
        buffers_.reserve(info.vertex_count, info.face_count);
    }
}

Result<std::size_t> Refiner::feed(std::span<const std::byte> bytes)
{
    return decoder_.feed(bytes);
}

Result<Progress> Refiner::advance(std::chrono::duration<double> budget)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    Progress progress;
    bool going = true;
    while (going)
    {
        const auto step = decoder_.step();
        VSPLIT_TRY(step);
        if (step->kind == codec::StepKind::NeedBytes || step->kind == codec::StepKind::Complete)
        {
            break;
        }
        VSPLIT_TRY(follow(*step, progress));
        going = !progress.level_complete && Clock::now() - start < budget;
    }
    progress.decoding = Clock::now() - start;
    return progress;
}

Result<void> Refiner::follow(const codec::Step& step, Progress& progress)
{
    if (step.kind == codec::StepKind::Chunk && !attributes_)
    {
        buffers_.apply(step, positions_, triangles_);
        progress.changed = true;
    }
    if (step.chunk == nullptr)
    {
        return {};
    }
    progress.bytes.add(step.chunk->kind, step.chunk_bytes);
    // Attributes fit the mesh that they came with, until it changes.
    fitting_ = step.attributes_complete || (fitting_ && !is_required(*step.chunk));
    at_level_ = step.level_complete || (at_level_ && !is_required(*step.chunk));
    if (step.level_complete)
    {
        awaiting_ = attributes_ && !fitting_ && awaits_attributes();
        progress.level_complete = !awaiting_;
    }
    else if (awaiting_ && (step.attributes_complete || !awaits_attributes()))
    {
        awaiting_ = false;
        progress.level_complete = true;
    }
    return sink_ && is_appearance(*step.chunk) ? sink_(*step.chunk, step.contents) : Result<void>{};
}

// Whether chunks with attributes come before the mesh changes again.
bool Refiner::awaits_attributes() const
{
    const codec::ChunkInfo* next = decoder_.next_chunk();
    if (next == nullptr)
    {
        return false;
    }
    const std::vector<codec::ChunkInfo>& chunks = decoder_.info()->chunks;
    for (auto i = static_cast<std::size_t>(next - chunks.data()); i < chunks.size(); ++i)
    {
        if (chunks[i].offset + chunks[i].bytes > end_)
        {
            return false;
        }
        if (is_required(chunks[i]) || chunks[i].kind == proto::ChunkKind::Attributes)
        {
            return !is_required(chunks[i]);
        }
    }
    return false;
}

void Refiner::skip()
{
    decoder_.skip();
}

SurfaceArrays Refiner::make_surface(const Appearance* appearance) const
{
    std::vector<std::array<float, 3>> positions(decoder_.vertices());
    std::vector<Triangle> triangles(decoder_.faces());
    constexpr std::uint32_t kBlock = 256;
    std::array<float, 3 * kBlock> block{};
    for (std::uint32_t first = 0; first < decoder_.vertices(); first += kBlock)
    {
        const std::uint32_t count = std::min(kBlock, decoder_.vertices() - first);
        decoder_.write_positions(first, count, block);
        for (std::uint32_t i = 0; i < count; ++i)
        {
            positions[first + i] = {block[3 * i], block[3 * i + 1], block[3 * i + 2]};
        }
    }
    decoder_.write_triangles(triangles);
    SurfaceInput input;
    input.positions = positions;
    input.triangles = triangles;
    input.infos = decoder_.info()->attributes;
    input.attributes = level_attributes();
    input.appearance = appearance;
    return make_surface_arrays(input);
}

}  // namespace vsplit::client
