// Attributes that contradict their stream are refused, and never more than that.

#include "codec/attribute_coder.h"
#include "codec/attributed_samples.h"
#include "codec/shapes.h"
#include "core/byte_writer.h"

#include <gtest/gtest.h>

#include <functional>

namespace vsplit::test {
namespace {

using codec::BitEncoder;
using codec::ChunkInfo;
using proto::ChunkKind;

/// A stream of splits with attributes behind several levels.
const StreamParts& sample()
{
    static const StreamParts kParts = take_apart(
        encode(
            attributed(textured("torus", torus(20, 14, 0.05, 1), 4, 0.05, 1), every_kind()),
            {.grow_last_level = false}
        )
            .file
    );
    return kParts;
}

bool is_attributes(const ChunkInfo& chunk)
{
    return chunk.kind == ChunkKind::Attributes;
}

/// Places of the chunks of a codec.
std::vector<std::size_t> places(const StreamParts& parts, std::uint8_t codec)
{
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < parts.info.chunks.size(); ++i)
    {
        if (is_attributes(parts.info.chunks[i]) && parts.info.chunks[i].codec == codec)
        {
            result.push_back(i);
        }
    }
    return result;
}

void erase_chunk(StreamParts& parts, std::size_t place)
{
    parts.info.chunks.erase(parts.info.chunks.begin() + static_cast<std::ptrdiff_t>(place));
    parts.chunks.erase(parts.chunks.begin() + static_cast<std::ptrdiff_t>(place));
}

/// Inserts a chunk of attributes behind chunk `after`.
void insert_chunk(StreamParts& parts, std::size_t after, std::uint8_t codec, const Bytes& bytes)
{
    ChunkInfo row = parts.info.chunks[after];
    row.kind = ChunkKind::Attributes;
    row.codec = codec;
    const auto at = static_cast<std::ptrdiff_t>(after) + 1;
    parts.info.chunks.insert(parts.info.chunks.begin() + at, row);
    parts.chunks.insert(parts.chunks.begin() + at, bytes);
}

/// The sample without attributes.
StreamParts bare()
{
    StreamParts parts = sample();
    for (std::size_t i = parts.chunks.size(); i-- > 0;)
    {
        if (is_attributes(parts.info.chunks[i]))
        {
            erase_chunk(parts, i);
        }
    }
    return parts;
}

Bytes written(const std::function<void(BitEncoder&)>& write)
{
    BitEncoder bits;
    write(bits);
    ByteWriter bytes;
    bits.finish(bytes);
    return bytes.take();
}

/// A first chunk: `groups`, no seams, texture coordinates that lack nothing, and that many values claimed.
Bytes first_chunk(std::uint32_t groups, std::uint32_t values)
{
    return written([&](BitEncoder& bits) {
        static_cast<void>(codec::code_count(bits, groups - 1));
        bits.raw(0, 1);
        bits.raw(0, codec::kLackingBits);
        static_cast<void>(codec::code_count(bits, values));
    });
}

ErrorCode code_of(const StreamParts& parts)
{
    const Decoded decoded = decode(put_together(parts));
    return decoded.error ? decoded.error->code : ErrorCode::Ok;
}

TEST(HostileAttributes, AreNoneInTheSample)
{
    EXPECT_EQ(code_of(sample()), ErrorCode::Ok);
    EXPECT_EQ(code_of(bare()), ErrorCode::Ok);
    EXPECT_GE(places(sample(), proto::kValuesCodec).size(), 3U);
    EXPECT_EQ(places(sample(), proto::kNormalsCodec).size(), 1U);
}

TEST(HostileAttributes, AreRefusedTwice)
{
    for (const std::size_t place : places(sample(), proto::kValuesCodec))
    {
        StreamParts parts = sample();
        insert_chunk(parts, place, proto::kValuesCodec, sample().chunks[place]);
        EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
    }
    StreamParts parts = sample();
    const std::size_t normals = places(parts, proto::kNormalsCodec).front();
    insert_chunk(parts, normals, proto::kNormalsCodec, sample().chunks[normals]);
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
}

TEST(HostileAttributes, AreRefusedWithinALevel)
{
    // A level of two chunks: positions get their bits first, and there are more than one chunk brings.
    const AttributedSample large = encode(
        attributed(textured("torus", torus(150, 120, 0.01, 1), 2, 0.0, 1), {}),
        {.position_bits = 16, .grow_last_level = false, .threads = 2}
    );
    StreamParts parts = take_apart(large.file);
    const auto within = std::ranges::find_if(parts.info.chunks, [](const ChunkInfo& chunk) {
        return !is_attributes(chunk) && !chunk.ends_level;
    });
    ASSERT_NE(within, parts.info.chunks.end());
    const auto place = static_cast<std::size_t>(within - parts.info.chunks.begin());
    insert_chunk(parts, place, proto::kValuesCodec, first_chunk(1, 0));
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
}

TEST(HostileAttributes, AreRefusedWhenTheyAreNotComplete)
{
    StreamParts parts = bare();
    insert_chunk(parts, 0, proto::kValuesCodec, first_chunk(1, 0));
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk) << "another level follows";
    parts = bare();
    insert_chunk(parts, parts.chunks.size() - 1, proto::kValuesCodec, first_chunk(1, 0));
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk) << "the stream ends";
}

TEST(HostileAttributes, AreRefusedWithNormalsTooEarly)
{
    const Bytes normals = sample().chunks[places(sample(), proto::kNormalsCodec).front()];
    for (std::size_t place = 0; place + 1 < sample().chunks.size(); ++place)
    {
        StreamParts parts = sample();
        erase_chunk(parts, places(parts, proto::kNormalsCodec).front());
        if (place + 1 < parts.chunks.size())
        {
            insert_chunk(parts, place, proto::kNormalsCodec, normals);
            EXPECT_EQ(code_of(parts), ErrorCode::BadChunk) << place;
        }
    }
}

TEST(HostileAttributes, AreRefusedWithCountsThatAreTooLarge)
{
    const std::uint32_t vertices = sample().info.chunks[0].vertices;
    for (const std::uint32_t count : {vertices + 1, 1U << 20, (1U << 31) - 1})
    {
        StreamParts parts = bare();
        insert_chunk(parts, 0, proto::kValuesCodec, first_chunk(1, count));
        EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
    }
    StreamParts parts = bare();
    insert_chunk(parts, 0, proto::kValuesCodec, first_chunk(codec::kMaxGroups + 1, 0));
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
    parts = sample();
    erase_chunk(parts, places(parts, proto::kNormalsCodec).front());
    const Bytes normals = written([&](BitEncoder& bits) {
        static_cast<void>(codec::code_count(bits, parts.info.wedge_count + 1));
        bits.raw(0, 5);
    });
    insert_chunk(parts, parts.chunks.size() - 1, proto::kNormalsCodec, normals);
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
}

TEST(HostileAttributes, AreRefusedWithMoreWedgesThanTheHeaderSays)
{
    StreamParts parts = sample();
    --parts.info.wedge_count;
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
    parts.info.wedge_count = parts.info.vertex_count;
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
}

TEST(HostileAttributes, AreRefusedWithoutATable)
{
    StreamParts parts = sample();
    parts.info.wedge_count = 0;
    parts.info.attributes.clear();
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
}

TEST(HostileAttributes, AreRefusedWithValuesOutOfRange)
{
    for (std::size_t attribute = 0; attribute < every_kind().size(); ++attribute)
    {
        StreamParts parts = sample();
        parts.info.attributes[attribute].bits = 2;
        EXPECT_EQ(code_of(parts), ErrorCode::BadChunk) << attribute;
    }
}

TEST(HostileAttributes, AreRefusedWithBytesLeftOver)
{
    for (std::size_t i = 0; i < sample().chunks.size(); ++i)
    {
        if (is_attributes(sample().info.chunks[i]))
        {
            StreamParts parts = sample();
            parts.chunks[i].push_back(std::byte{0});
            EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
            parts.chunks[i].clear();
            EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
        }
    }
}

TEST(HostileAttributes, AreSkippedWhenTheirCodecIsUnknown)
{
    StreamParts parts = sample();
    for (ChunkInfo& chunk : parts.info.chunks)
    {
        chunk.codec = is_attributes(chunk) ? 3 : chunk.codec;
    }
    const Decoded decoded = decode(put_together(parts));
    EXPECT_TRUE(decoded.complete);
    EXPECT_TRUE(decoded.attributes.empty());
}

TEST(HostileAttributes, AreRefusedOrWholeWhateverTheirBitsSay)
{
    for (std::size_t i = 0; i < sample().chunks.size(); ++i)
    {
        if (!is_attributes(sample().info.chunks[i]))
        {
            continue;
        }
        StreamParts parts = sample();
        for (std::size_t byte = 0; byte < parts.chunks[i].size(); byte += 7)
        {
            parts.chunks[i][byte] ^= std::byte{0x24};
            const ErrorCode code = code_of(parts);
            EXPECT_TRUE(code == ErrorCode::BadChunk || code == ErrorCode::Ok) << i << ' ' << byte;
            parts.chunks[i][byte] ^= std::byte{0x24};
        }
    }
}

}  // namespace
}  // namespace vsplit::test
