#include "codec/stream_info.h"

#include "codec/attribute_state.h"
#include "codec/base_mesh_tables.h"
#include "core/crc32c.h"

#include <algorithm>
#include <cmath>

namespace vsplit::codec {

double StreamInfo::diagonal() const
{
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double length = box_max[axis] - box_min[axis];
        sum += length * length;
    }
    return std::sqrt(sum);
}

std::uint32_t with_picture_quality(std::uint32_t tag, double squared_error)
{
    constexpr double kMost = 63.75;
    const double ratio = squared_error > 0.0 ? 10.0 * std::log10(65025.0 / squared_error) : kMost;
    const auto steps = static_cast<std::uint32_t>(std::clamp(ratio, 0.25, kMost) * 4.0);
    return (tag & ~(255U << 4U)) | steps << 4U;
}

Result<std::span<const std::byte>> chunk_contents(
    std::span<const std::byte> bytes, std::uint64_t offset
)
{
    if (bytes.size() < proto::kChunkChecksumBytes || crc32c(bytes) != kCrc32cResidue)
    {
        return fail(ErrorCode::BadChecksum, "a chunk is damaged", offset);
    }
    return bytes.first(bytes.size() - proto::kChunkChecksumBytes);
}

std::uint64_t stop_offset(const StreamInfo& info, const StopCondition& stop)
{
    const auto too_far = [&](const ChunkInfo& chunk) {
        return chunk.offset + chunk.bytes > stop.bytes ||
               (!is_optional(chunk.kind) && chunk.faces > stop.faces);
    };
    // Not the first level's end: its attributes may be more than what is asked for.
    std::uint64_t end = info.chunks.front().offset + info.chunks.front().bytes;
    std::uint32_t level = 0;
    double error = info.levels.front().rms_error;
    for (std::size_t i = 1; i < info.chunks.size(); ++i)
    {
        const ChunkInfo& chunk = info.chunks[i];
        const bool optional = is_optional(chunk.kind);
        if (!optional && (level >= stop.level || error <= stop.error))
        {
            break;
        }
        if (too_far(chunk))
        {
            break;
        }
        end = chunk.offset + chunk.bytes;
        if (!optional && chunk.ends_level)
        {
            ++level;
            error = chunk.rms_error;
        }
    }
    return end;
}

StreamInfo prefix_info(const StreamInfo& info, std::uint32_t level)
{
    if (level + 1ULL >= info.levels.size())
    {
        return info;
    }
    StreamInfo prefix = info;
    prefix.file_bytes = stop_offset(info, StopCondition{.level = level});
    prefix.levels.resize(std::size_t{level} + 1);
    prefix.vertex_count = prefix.levels.back().vertices;
    prefix.wedge_count = most_wedges({info.wedge_count, info.vertex_count}, prefix.vertex_count);
    prefix.face_count = prefix.levels.back().faces;
    std::erase_if(prefix.chunks, [&](const ChunkInfo& chunk) {
        return chunk.offset >= prefix.file_bytes;
    });
    return prefix;
}

StreamInfo without_attributes(StreamInfo info)
{
    std::erase_if(info.chunks, [](const ChunkInfo& chunk) {
        return chunk.kind == proto::ChunkKind::Attributes;
    });
    return info;
}

LargestChunk largest_chunk(const StreamInfo& info)
{
    LargestChunk largest;
    std::uint32_t vertices = info.chunks.front().vertices;
    for (const ChunkInfo& chunk : info.chunks)
    {
        largest.bytes = std::max(largest.bytes, chunk.bytes);
        if (chunk.kind == proto::ChunkKind::Growth)
        {
            vertices = info.vertex_count;  // splits nothing, and nothing splits after it
            continue;
        }
        if (chunk.kind == proto::ChunkKind::Parts)
        {
            vertices = chunk.vertices;  // splits nothing
            continue;
        }
        largest.splits =
            std::max(largest.splits, chunk.vertices - std::min(vertices, chunk.vertices));
        vertices = chunk.vertices;
    }
    return largest;
}

RefinedCounts refined_counts(const StreamInfo& info)
{
    RefinedCounts counts;
    for (const ChunkInfo& chunk : info.chunks)
    {
        if (chunk.kind == proto::ChunkKind::Growth)
        {
            break;
        }
        counts = {chunk.vertices, chunk.faces};
    }
    return counts;
}

namespace {

/// Heap for growing a complete mesh over a coarse one.
std::uint64_t growth_heap_bytes(const StreamInfo& info, const RefinedCounts& coarse)
{
    // Per face: vertices and neighbours. Per vertex: position, number, coarse face, sizes of residuals,
    // a count of faces, its turn in either list; while faces grow, at most as much for the border. Per
    // coarse vertex: whether it was met and a face. The constant covers the learned model.
    constexpr std::uint64_t kFixed = 256U * 1024U;
    return kFixed + 24ULL * info.face_count + 30ULL * info.vertex_count + 5ULL * coarse.vertices;
}

/// Heap for decoding the largest Parts chunk beside the mesh, and for linking it.
std::uint64_t parts_heap_bytes(const StreamInfo& info)
{
    std::uint64_t most = 0;
    for (std::size_t i = 1; i < info.chunks.size(); ++i)
    {
        if (info.chunks[i].kind == proto::ChunkKind::Parts)
        {
            const std::uint64_t vertices = info.chunks[i].vertices - info.chunks[i - 1].vertices;
            const std::uint64_t faces = info.chunks[i].faces - info.chunks[i - 1].faces;
            most = std::max(most, 512 * std::max(vertices, faces / 2));
        }
    }
    return most;
}

/// Heap for attributes.
std::uint64_t attribute_heap_bytes(const StreamInfo& info)
{
    const std::uint64_t faces = info.face_count;
    const std::uint64_t vertices = info.vertex_count;
    const std::uint64_t wedges = info.wedge_count;
    std::uint64_t numbers = 0;
    std::uint64_t normals = 0;
    for (const AttributeInfo& attribute : info.attributes)
    {
        const bool is_normal = attribute.kind == AttributeKind::Normal;
        numbers += is_normal ? 0 : attribute.components;
        normals += is_normal ? 1 : 0;
    }
    // Per face: its wedges and group; a copy of the mesh. Per vertex: its first wedge; in the copy its
    // position. Per wedge: its vertex, the next one, its values.
    const std::uint64_t lasting =
        40 * faces + 16 * vertices + (8 + 4 * numbers + 8 * normals) * wedges;
    // Then, while the level's wedges are coded, per face the new ones, per vertex its fan, whether seams go
    // on there, and the longest of all fans, which may be that of a hub.
    const std::uint64_t finding = 12 * faces + 32 * vertices;
    // Or, while values are, per face the corners of wedges, per wedge its corners, its turn, and the size of
    // the residuals; those of normals know deviations, too.
    const std::uint64_t sizes = std::max<std::uint64_t>(4 * numbers, normals > 0 ? 16 : 0);
    const std::uint64_t valuing = 12 * faces + (14 + sizes) * wedges;
    // The learned models and small things.
    constexpr std::uint64_t kFixed = 48U * 1024U;
    constexpr std::uint64_t kModel = kResidualContexts * sizeof(IntegerModel);
    return kFixed + numbers * kModel + lasting + std::max(finding, valuing);
}

}  // namespace

std::uint64_t decoder_heap_bytes(const StreamInfo& info)
{
    const bool stitched = std::ranges::any_of(info.chunks, [](const ChunkInfo& chunk) {
        return chunk.kind == proto::ChunkKind::Stitch;
    });
    const bool grows = std::ranges::any_of(info.chunks, [](const ChunkInfo& chunk) {
        return chunk.kind == proto::ChunkKind::Growth;
    });
    const bool attributed = std::ranges::any_of(info.chunks, [](const ChunkInfo& chunk) {
        return chunk.kind == proto::ChunkKind::Attributes;
    });
    std::uint64_t names = 0;
    for (const AttributeInfo& attribute : info.attributes)
    {
        names += 3 * (sizeof(AttributeInfo) + attribute.name.size());
    }
    const LargestChunk largest = largest_chunk(info);
    const RefinedCounts refined = refined_counts(info);
    // The base first: per vertex what Draco needs besides the tables of its entropy coder.
    const ChunkInfo& base = info.chunks.front();
    const auto max_index = static_cast<std::uint32_t>(info.grid.max_index());
    const std::uint64_t draco = BaseMeshTables::of(base.vertices, max_index).heap_bytes() +
                                512ULL * std::max(base.vertices, base.faces / 2);
    // Then, beside the decoded base, the tables that link it. Per vertex: position and valence; its
    // stitch, its place in their order, one class of its own. Per face: connectivity. Per split of the
    // largest chunk: where it is.
    const std::uint64_t mesh =
        20ULL * base.vertices + 60ULL * base.faces + 14ULL * refined.vertices +
        12ULL * (stitched ? info.vertex_count : 0) + 32ULL * refined.faces + 8ULL * largest.splits +
        parts_heap_bytes(info) + (grows ? growth_heap_bytes(info, refined) : 0);
    // The learned model and small things.
    constexpr std::uint64_t kFixed = 128U * 1024U;
    return kFixed + std::max(draco, mesh) + largest.bytes +
           sizeof(ChunkInfo) * info.chunks.size() * 2 + names +
           (attributed ? attribute_heap_bytes(info) : 0);
}

}  // namespace vsplit::codec
