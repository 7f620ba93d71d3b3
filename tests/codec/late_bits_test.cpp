// Texture coordinates of coarse levels lack bits, and the last bits of everything come in the end.

#include "codec/attribute_coder.h"
#include "codec/attributed_samples.h"
#include "codec/entropy_coder.h"
#include "codec/shapes.h"
#include "codec/value_precision.h"
#include "core/byte_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

namespace vsplit::test {
namespace {

using codec::BitEncoder;
using codec::ChunkInfo;

constexpr int kLateBits = 2;

const TexturedShape& shape()
{
    static const TexturedShape kShape = textured("torus", torus(40, 28, 0.05, 1), 4, 0.05, 1);
    return kShape;
}

/// A stream of splits whose last bits come late.
const AttributedSample& sample()
{
    static const AttributedSample kSample = encode(
        attributed(shape(), every_kind()), {.grow_last_level = false, .late_bits = kLateBits}
    );
    return kSample;
}

const StreamParts& parts_of_sample()
{
    static const StreamParts kParts = take_apart(sample().file);
    return kParts;
}

ErrorCode code_of(const StreamParts& parts)
{
    const Decoded decoded = decode(put_together(parts));
    return decoded.error ? decoded.error->code : ErrorCode::Ok;
}

/// The place of the chunk with the last bits.
std::size_t late_place(const StreamParts& parts)
{
    const auto found = std::ranges::find_if(parts.info.chunks, [](const ChunkInfo& chunk) {
        return chunk.kind == proto::ChunkKind::Attributes && chunk.codec == proto::kLateBitsCodec;
    });
    return static_cast<std::size_t>(found - parts.info.chunks.begin());
}

/// The largest difference of texture coordinates to those of the complete mesh.
std::int32_t largest_gap(const ShownAttributes& shown, const ShownAttributes& last)
{
    std::int32_t gap = 0;
    for (std::size_t a = 0; a < every_kind().size(); ++a)
    {
        const auto& values = shown.attributes.values[a];
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            const std::int32_t off = std::abs(values[i] - last.attributes.values[a][i]);
            if (codec::may_lack_bits(every_kind()[a]))
            {
                gap = std::max(gap, off);
            }
            else
            {
                EXPECT_EQ(off, 0) << "attribute " << a;
            }
        }
    }
    return gap;
}

TEST(LateBits, ComeBackForEveryShape)
{
    for (const TexturedShape& each : textured_shapes())
    {
        SCOPED_TRACE(each.name);
        const AttributedSample coded = encode(
            attributed(each, every_kind()), {.grow_last_level = false, .late_bits = kLateBits}
        );
        const Decoded decoded = decode(coded.file);
        ASSERT_FALSE(decoded.error.has_value()) << describe(*decoded.error);
        EXPECT_EQ(face_rows(coded.info, decoded), face_rows(coded));
    }
}

TEST(LateBits, ComeBehindALevelThatHasEveryVertex)
{
    const auto& levels = sample().info.levels;
    ASSERT_GE(levels.size(), 3U);
    const auto& before = levels[levels.size() - 2];
    EXPECT_EQ(before.vertices, sample().info.vertex_count);
    EXPECT_EQ(before.faces, sample().info.face_count);
    const Decoded decoded = decode(sample().file);
    EXPECT_EQ(decoded.levels[levels.size() - 2].shift, kLateBits);
    EXPECT_EQ(decoded.levels.back().shift, 0);
    EXPECT_GT(before.rms_error, levels.back().rms_error);
}

TEST(LateBits, LeaveTextureCoordinatesNearerAndNearer)
{
    const Decoded decoded = decode(sample().file);
    ASSERT_GE(decoded.attributes.size(), 4U);
    std::int32_t before = 1 << 10;
    for (const ShownAttributes& shown : decoded.attributes)
    {
        const std::int32_t gap = largest_gap(shown, decoded.attributes.back());
        EXPECT_LE(gap, before);
        before = gap;
    }
    EXPECT_GT(largest_gap(decoded.attributes.front(), decoded.attributes.back()), 1 << kLateBits);
    // With the values of the last level and its normals all is there but the last bits.
    const ShownAttributes& last_but_one = decoded.attributes[decoded.attributes.size() - 2];
    EXPECT_EQ(largest_gap(last_but_one, decoded.attributes.back()), 1 << (kLateBits - 1));
}

TEST(LateBits, SaveBytesOfTheBase)
{
    const AttributedSample exact =
        encode(attributed(shape(), every_kind()), {.grow_last_level = false});
    EXPECT_LT(
        sample().info.levels.front().cumulative_bytes, exact.info.levels.front().cumulative_bytes
    );
}

TEST(LateBits, AreLeftOutWhereTheLastLevelIsGrown)
{
    const auto input = attributed(shape(), every_kind());
    EXPECT_EQ(encode(input).file, encode(input, {.late_bits = kLateBits}).file);
}

TEST(LateBits, AreRefusedTwiceOrInPart)
{
    const StreamParts& whole = parts_of_sample();
    const std::size_t place = late_place(whole);
    ASSERT_LT(place, whole.chunks.size());
    StreamParts parts = whole;
    const auto at = static_cast<std::ptrdiff_t>(place);
    parts.info.chunks.insert(parts.info.chunks.begin() + at, whole.info.chunks[place]);
    parts.chunks.insert(parts.chunks.begin() + at, whole.chunks[place]);
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);

    for (const std::uint32_t count : {whole.info.wedge_count - 1, whole.info.wedge_count + 1})
    {
        BitEncoder bits;
        static_cast<void>(codec::code_count(bits, count));
        for (std::uint32_t i = 0; i < 2 * count; ++i)
        {
            bits.raw(1, kLateBits);
        }
        ByteWriter bytes;
        bits.finish(bytes);
        parts = whole;
        parts.chunks[place] = bytes.take();
        EXPECT_EQ(code_of(parts), ErrorCode::BadChunk) << count;
    }
}

TEST(LateBits, AreRefusedBeforeTheLastLevelIsComplete)
{
    const StreamParts& whole = parts_of_sample();
    const std::size_t late = late_place(whole);
    for (std::size_t place = 1; place < late; ++place)
    {
        const ChunkInfo& before = whole.info.chunks[place - 1];
        const bool last_level = before.vertices == whole.info.vertex_count && before.shift == 0;
        if (last_level)
        {
            break;
        }
        StreamParts parts = whole;
        const auto at = static_cast<std::ptrdiff_t>(place);
        parts.info.chunks.insert(parts.info.chunks.begin() + at, whole.info.chunks[late]);
        parts.chunks.insert(parts.chunks.begin() + at, whole.chunks[late]);
        EXPECT_EQ(code_of(parts), ErrorCode::BadChunk) << place;
    }
}

TEST(LateBits, MayBeMissing)
{
    StreamParts parts = parts_of_sample();
    const auto at = static_cast<std::ptrdiff_t>(late_place(parts));
    parts.info.chunks.erase(parts.info.chunks.begin() + at);
    parts.chunks.erase(parts.chunks.begin() + at);
    EXPECT_EQ(code_of(parts), ErrorCode::Ok);
}

TEST(LateBits, AreNotMoreThanANumberHas)
{
    // Fewer bits in the header than the base says that its texture coordinates lack.
    StreamParts parts = parts_of_sample();
    parts.info.attributes.front().bits = 1;
    ASSERT_TRUE(codec::may_lack_bits(parts.info.attributes.front()));
    EXPECT_EQ(code_of(parts), ErrorCode::BadChunk);
}

TEST(LateBits, KeepNumbersInTheMiddleOfWhatTheyMayBecome)
{
    EXPECT_EQ(codec::middle_of(13, 0), 13);
    EXPECT_EQ(codec::middle_of(13, 1), 13);
    EXPECT_EQ(codec::middle_of(12, 1), 13);
    EXPECT_EQ(codec::middle_of(13, 2), 14);
    EXPECT_EQ(codec::middle_of(1023, 10), 512);
}

}  // namespace
}  // namespace vsplit::test
