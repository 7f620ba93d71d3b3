// Decodes hostile batches on a sound base: an octahedron or an open strip. Every chunk begins with a
// row of the index: kind and flags, splits, boundary splits, length, a byte each; then its contents.

#include "codec/shapes.h"
#include "codec/stream_parts.h"
#include "core/byte_reader.h"
#include "fuzz/base_stream.h"
#include "fuzz/decoder_check.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace {

using namespace vsplit;

constexpr int kBaseShift = 4;

struct Row
{
    unsigned flags =
        0;  ///< 1: the level goes on; 2: optional kind; 4: stitches; from 8 on: shift drop.
    unsigned splits = 0;
    unsigned boundary = 0;
    unsigned length = 0;
};

bool read_row(ByteReader& reader, Row& row)
{
    const auto bytes = reader.read<std::uint32_t>();
    if (!bytes)
    {
        return false;
    }
    row = {*bytes & 255U, *bytes >> 8 & 255U, *bytes >> 16 & 255U, *bytes >> 24};
    return true;
}

void add_chunk(test::StreamParts& parts, const Row& row, std::span<const std::byte> contents)
{
    codec::ChunkInfo chunk = parts.info.chunks.back();
    chunk.kind = (row.flags & 4U) != 0   ? proto::ChunkKind::Stitch
                 : (row.flags & 2U) != 0 ? static_cast<proto::ChunkKind>(200)
                                         : proto::ChunkKind::Batch;
    chunk.ends_level = (row.flags & 1U) == 0;
    if (chunk.kind == proto::ChunkKind::Batch)
    {
        const auto drop = static_cast<int>(row.flags >> 3);
        chunk.shift -= parts.info.chunks.back().ends_level ? std::min(drop, chunk.shift) : 0;
        chunk.vertices += row.splits;
        chunk.faces += 2 * row.splits - std::min(row.boundary, row.splits);
    }
    parts.info.chunks.push_back(chunk);
    parts.chunks.emplace_back(contents.begin(), contents.end());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const test::StreamParts kClosed = fuzz::base_stream(test::octahedron(), kBaseShift);
    static const test::StreamParts kOpen = fuzz::base_stream(test::strip(6), kBaseShift);
    ByteReader reader(std::as_bytes(std::span(data, size)));
    const auto shape = reader.read<std::uint8_t>();
    if (!shape)
    {
        return 0;
    }
    test::StreamParts parts = *shape % 2 == 0 ? kClosed : kOpen;
    for (Row row; read_row(reader, row);)
    {
        add_chunk(
            parts, row, *reader.read_bytes(std::min<std::size_t>(row.length, reader.remaining()))
        );
    }
    parts.info.vertex_count = parts.info.chunks.back().vertices;
    parts.info.face_count = parts.info.chunks.back().faces;
    const test::Bytes file = test::put_together(parts);
    fuzz::check_stream(file, file.size());
    return 0;
}
