#include "codec/stream_parts.h"

#include "codec/stream_header_writer.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"
#include "core/file_io.h"
#include "format.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vsplit::test {
namespace {

void write_checksum(std::span<std::byte> place, std::uint32_t checksum)
{
    ByteWriter bytes;
    bytes.write(checksum);
    std::ranges::copy(bytes.view(), place.begin());
}

}  // namespace

StreamParts take_apart(std::span<const std::byte> file)
{
    StreamParts parts;
    parts.info = codec::parse_stream_info(file).value();
    const QuantizationGrid& grid = parts.info.grid;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        parts.extent[axis] = static_cast<std::int32_t>(
            std::lround((parts.info.box_max[axis] - grid.origin[axis]) / grid.cell)
        );
    }
    for (const codec::ChunkInfo& chunk : parts.info.chunks)
    {
        const auto bytes = file.subspan(
            static_cast<std::size_t>(chunk.offset), chunk.bytes - proto::kChunkChecksumBytes
        );
        parts.chunks.emplace_back(bytes.begin(), bytes.end());
    }
    return parts;
}

Bytes put_together(const StreamParts& parts)
{
    codec::StreamInfo info = parts.info;
    ByteWriter payload;
    info.content_checksum = 0;
    for (std::size_t i = 0; i < parts.chunks.size(); ++i)
    {
        const Bytes& chunk = parts.chunks[i];
        info.chunks[i].bytes =
            static_cast<std::uint32_t>(chunk.size()) + proto::kChunkChecksumBytes;
        payload.write_bytes(chunk);
        payload.write(crc32c(chunk));
        info.content_checksum =
            crc32c(payload.view().last(proto::kChunkChecksumBytes), info.content_checksum);
    }
    Bytes file = codec::write_stream_header(info, parts.extent);
    file.insert(file.end(), payload.view().begin(), payload.view().end());
    return file;
}

void repair_checksums(Bytes& file)
{
    const std::size_t header_bytes = codec::parse_header_bytes(file).value_or(0);
    if (header_bytes < proto::kHeaderProbeBytes || header_bytes > file.size())
    {
        return;
    }
    const std::size_t place = header_bytes - proto::kChunkChecksumBytes;
    write_checksum(std::span(file).subspan(place), crc32c(std::span(file).first(place)));
    const auto info = codec::parse_stream_info(file);
    for (std::size_t i = 0; info && i < info->chunks.size(); ++i)
    {
        const codec::ChunkInfo& chunk = info->chunks[i];
        if (chunk.bytes < proto::kChunkChecksumBytes || chunk.offset + chunk.bytes > file.size())
        {
            return;
        }
        const auto bytes =
            std::span(file).subspan(static_cast<std::size_t>(chunk.offset), chunk.bytes);
        const std::size_t length = bytes.size() - proto::kChunkChecksumBytes;
        write_checksum(bytes.subspan(length), crc32c(bytes.first(length)));
    }
}

Snapshot snapshot(const codec::StreamDecoder& decoder)
{
    Snapshot shown{.level = decoder.level(), .shift = decoder.shift(), .mesh = {}};
    for (std::uint32_t v = 0; v < decoder.vertices(); ++v)
    {
        shown.mesh.positions.push_back(decoder.grid_position(v));
    }
    shown.mesh.triangles.resize(decoder.faces());
    decoder.write_triangles(shown.mesh.triangles);
    return shown;
}

Decoded decode(std::span<const std::byte> file, const codec::DecodeLimits& limits)
{
    codec::StreamDecoder decoder(limits);
    Decoded result;
    while (true)
    {
        const auto taken = decoder.feed(file.subspan(result.taken));
        result.taken += taken.value_or(0);
        const auto step = decoder.step();
        if (!step)
        {
            result.error = step.error();
            break;
        }
        const bool idle = step->kind == codec::StepKind::NeedBytes && *taken == 0;
        if (idle || step->kind == codec::StepKind::Complete)
        {
            break;
        }
        if (step->kind == codec::StepKind::Chunk)
        {
            result.chunks.push_back(snapshot(decoder));
        }
        if (step->level_complete)
        {
            result.levels.push_back(snapshot(decoder));
        }
        if (step->attributes_complete)
        {
            result.attributes.push_back({decoder.level(), *decoder.attributes()});
        }
    }
    result.last = snapshot(decoder);
    result.complete = decoder.complete();
    result.stitches.assign(decoder.stitches().begin(), decoder.stitches().end());
    return result;
}

Bytes read_source_file(const std::filesystem::path& path)
{
    auto bytes = read_file(path);
    if (!bytes)
    {
        throw std::runtime_error(describe(bytes.error()));
    }
    return std::move(*bytes);
}

}  // namespace vsplit::test
