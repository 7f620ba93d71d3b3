// Adds hostile components to a sound base: an octahedron or an open strip. Every chunk begins with the
// numbers of its vertices and faces and its length, two bytes each.

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

/// Result: false when there is no chunk left.
bool add_chunk(test::StreamParts& parts, ByteReader& reader)
{
    const auto vertices = reader.read<std::uint16_t>();
    const auto faces = reader.read<std::uint16_t>();
    const auto length = reader.read<std::uint16_t>();
    if (!vertices || !faces || !length)
    {
        return false;
    }
    codec::ChunkInfo chunk = parts.info.chunks.back();
    chunk.kind = proto::ChunkKind::Parts;
    chunk.codec = 0;
    chunk.vertices += *vertices;
    chunk.faces += *faces;
    chunk.ends_level = (*length & 1) != 0;
    parts.info.chunks.push_back(chunk);
    const auto contents =
        *reader.read_bytes(std::min<std::size_t>(*length / 2, reader.remaining()));
    parts.chunks.emplace_back(contents.begin(), contents.end());
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const test::StreamParts kClosed = fuzz::base_stream(test::octahedron(), 3);
    static const test::StreamParts kOpen = fuzz::base_stream(test::strip(6), 0);
    ByteReader reader(std::as_bytes(std::span(data, size)));
    const auto shape = reader.read<std::uint8_t>();
    if (!shape)
    {
        return 0;
    }
    test::StreamParts parts = *shape % 2 == 0 ? kClosed : kOpen;
    while (add_chunk(parts, reader))
    {
    }
    parts.info.chunks.back().ends_level = true;
    parts.info.vertex_count = parts.info.chunks.back().vertices;
    parts.info.face_count = parts.info.chunks.back().faces;
    const test::Bytes file = test::put_together(parts);
    fuzz::check_stream(file, file.size());
    return 0;
}
