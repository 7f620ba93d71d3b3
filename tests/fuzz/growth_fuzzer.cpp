// Grows hostile meshes over a sound base: an octahedron or an open strip. Two bytes each say how many
// vertices and faces the complete mesh has; every chunk begins with its length in two bytes.

#include "codec/shapes.h"
#include "codec/stream_parts.h"
#include "core/byte_reader.h"
#include "fuzz/base_stream.h"
#include "fuzz/decoder_check.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace {

using namespace vsplit;

void add_chunk(test::StreamParts& parts, std::span<const std::byte> contents)
{
    codec::ChunkInfo chunk = parts.info.chunks.back();
    chunk.kind = proto::ChunkKind::Growth;
    chunk.ends_level = false;
    parts.info.chunks.push_back(chunk);
    parts.chunks.emplace_back(contents.begin(), contents.end());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const test::StreamParts kClosed = fuzz::base_stream(test::octahedron(), 3);
    static const test::StreamParts kOpen = fuzz::base_stream(test::strip(6), 0);
    ByteReader reader(std::as_bytes(std::span(data, size)));
    const auto shape = reader.read<std::uint8_t>();
    const auto vertices = reader.read<std::uint16_t>();
    const auto faces = reader.read<std::uint16_t>();
    if (!shape || !vertices || !faces)
    {
        return 0;
    }
    test::StreamParts parts = *shape % 2 == 0 ? kClosed : kOpen;
    while (const auto length = reader.read<std::uint16_t>())
    {
        add_chunk(parts, *reader.read_bytes(std::min<std::size_t>(*length, reader.remaining())));
    }
    codec::ChunkInfo& last = parts.info.chunks.back();
    if (last.kind != proto::ChunkKind::Growth)
    {
        return 0;
    }
    last.ends_level = true;
    last.shift = 0;
    last.vertices = std::max<std::uint32_t>(*vertices, parts.info.chunks.front().vertices);
    last.faces = std::max<std::uint32_t>(*faces, 1);
    parts.info.vertex_count = last.vertices;
    parts.info.face_count = last.faces;
    const test::Bytes file = test::put_together(parts);
    fuzz::check_stream(file, file.size());
    return 0;
}
