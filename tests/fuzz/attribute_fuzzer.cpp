// Decodes hostile attributes on the sound levels of two golden streams, one of which is grown at the end. The
// first byte chooses the stream and the attributes, the second one how many wedges the header promises; every
// chunk begins with its codec, the chunk of the stream that it stands behind, and its length in two bytes.

#include "codec/stream_parts.h"
#include "core/byte_reader.h"
#include "fuzz/decoder_check.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace {

using namespace vsplit;

/// The levels of a golden stream without what lies on them.
test::StreamParts bare_stream(const char* name)
{
    const std::string path = std::string(VSPLIT_SOURCE_DIR "/tests/golden/") + name + ".vsplit";
    test::StreamParts parts = test::take_apart(test::read_source_file(path));
    for (std::size_t i = parts.chunks.size(); i-- > 0;)
    {
        if (codec::is_optional(parts.info.chunks[i].kind))
        {
            const auto at = static_cast<std::ptrdiff_t>(i);
            parts.info.chunks.erase(parts.info.chunks.begin() + at);
            parts.chunks.erase(parts.chunks.begin() + at);
        }
    }
    return parts;
}

/// Attributes of every kind after those of the stream.
void choose_attributes(std::vector<codec::AttributeInfo>& attributes, unsigned choice)
{
    codec::AttributeInfo normals{.kind = AttributeKind::Normal, .components = 3, .bits = 9};
    codec::AttributeInfo scalars{.kind = AttributeKind::Scalar, .components = 4, .bits = 16};
    codec::AttributeInfo colors{
        .kind = AttributeKind::Color, .components = 4, .bits = 1, .rgb = true};
    switch (choice)
    {
        case 1:
            attributes.clear();
            break;
        case 2:
            attributes.insert(attributes.begin(), {normals, scalars});
            attributes.insert(attributes.end(), {colors, normals});
            break;
        case 3:
            attributes.resize(proto::kMaxAttributes, colors);
            break;
        default:
            break;
    }
}

/// One chunk and what it stands behind.
struct Extra
{
    std::size_t after;
    std::uint8_t codec;
    test::Bytes bytes;
};

std::vector<Extra> read_chunks(ByteReader& reader, std::size_t count)
{
    std::vector<Extra> chunks;
    while (chunks.size() < 64)
    {
        const auto codec = reader.read<std::uint8_t>();
        const auto after = reader.read<std::uint8_t>();
        const auto length = reader.read<std::uint16_t>();
        if (!codec || !after || !length)
        {
            break;
        }
        const auto bytes = *reader.read_bytes(std::min<std::size_t>(*length, reader.remaining()));
        chunks.push_back(
            {*after % count, static_cast<std::uint8_t>(*codec % 4), {bytes.begin(), bytes.end()}}
        );
    }
    std::ranges::stable_sort(chunks, {}, &Extra::after);
    return chunks;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const test::StreamParts kGrown = bare_stream("sheet");
    static const test::StreamParts kSplit = bare_stream("sheet_splits");
    ByteReader reader(std::as_bytes(std::span(data, size)));
    const auto choice = reader.read<std::uint8_t>();
    const auto slack = reader.read<std::uint8_t>();
    if (!choice || !slack)
    {
        return 0;
    }
    test::StreamParts parts = *choice % 2 == 0 ? kGrown : kSplit;
    choose_attributes(parts.info.attributes, *choice / 2 % 4U);
    parts.info.wedge_count = std::min(parts.info.vertex_count + *slack, 3 * parts.info.face_count);
    const std::vector<Extra> chunks = read_chunks(reader, parts.chunks.size());
    for (std::size_t i = chunks.size(); i-- > 0;)
    {
        const auto at = static_cast<std::ptrdiff_t>(chunks[i].after + 1);
        codec::ChunkInfo row = parts.info.chunks[chunks[i].after];
        row.kind = proto::ChunkKind::Attributes;
        row.codec = chunks[i].codec;
        parts.info.chunks.insert(parts.info.chunks.begin() + at, row);
        parts.chunks.insert(parts.chunks.begin() + at, chunks[i].bytes);
    }
    const test::Bytes file = test::put_together(parts);
    fuzz::check_stream(file, file.size());
    return 0;
}
