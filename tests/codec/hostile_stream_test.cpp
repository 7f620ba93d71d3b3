#include "codec/encoded_samples.h"
#include "codec/shapes.h"
#include "codec/stream_decoder.h"
#include "codec/stream_parts.h"
#include "precompute/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace vsplit::test {
namespace {

using codec::ChunkInfo;
using codec::StreamDecoder;
using proto::ChunkKind;

class Hostile : public ::testing::TestWithParam<NamedMesh>
{
protected:
    void SetUp() override { sample_ = encode(GetParam().make()); }

    [[nodiscard]] const EncodedSample& sample() const { return sample_; }

private:
    EncodedSample sample_;
};

INSTANTIATE_TEST_SUITE_P(
    Streams,
    Hostile,
    ::testing::Values(
        NamedMesh{"torus", [] { return torus(20, 12, 0.05, 3); }},
        NamedMesh{"holes", [] { return with_holes(height_field(16, 15, 0.5, 5), 0.05, 6); }},
        NamedMesh{"book", [] { return book(7); }},
        NamedMesh{"debris", [] { return with_holes(torus(20, 12, 0.1, 7), 0.5, 8); }}
    ),
    [](const auto& instance) { return instance.param.name; }
);

/// Accepts no mesh at all, too.
void expect_valid(const Snapshot& shown, int bits)
{
    if (shown.mesh.positions.empty() && shown.mesh.triangles.empty())
    {
        return;
    }
    IndexedMesh mesh{{}, shown.mesh.triangles};
    mesh.positions.resize(shown.mesh.positions.size());
    const auto checked = precompute::check_manifold(mesh);
    ASSERT_TRUE(checked.has_value()) << describe(checked.error());
    const std::int32_t most = ((std::int32_t{1} << bits) - 1) >> shown.shift;
    for (const auto& position : shown.mesh.positions)
    {
        ASSERT_TRUE(std::ranges::all_of(position, [&](std::int32_t x) {
            return x >= 0 && x <= most;
        }));
    }
}

TEST_P(Hostile, RejectsEveryChangedByte)
{
    const Decoded good = decode(sample().file);
    for (std::size_t i = 0; i < sample().file.size(); ++i)
    {
        for (const unsigned change : {0x01U, 0xFFU})
        {
            Bytes changed = sample().file;
            changed[i] ^= static_cast<std::byte>(change);
            const Decoded decoded = decode(changed);
            ASSERT_TRUE(decoded.error.has_value() || !decoded.complete) << "byte " << i;
            // What was shown until then is right.
            ASSERT_LE(decoded.chunks.size(), good.chunks.size());
            ASSERT_TRUE(std::ranges::equal(
                decoded.chunks, std::span(good.chunks).first(decoded.chunks.size())
            ));
        }
    }
}

TEST_P(Hostile, StaysValidWhateverAChunkHolds)
{
    const StreamParts good = take_apart(sample().file);
    std::size_t refused = 0;
    std::size_t accepted = 0;
    for (std::size_t c = 0; c < good.chunks.size(); ++c)
    {
        for (std::size_t i = 0; i < good.chunks[c].size(); ++i)
        {
            for (const unsigned change : {0x01U, 0x90U})
            {
                StreamParts parts = good;
                parts.chunks[c][i] ^= static_cast<std::byte>(change);
                const Decoded decoded = decode(put_together(parts));
                refused += decoded.error ? 1 : 0;
                accepted += decoded.complete ? 1 : 0;
                ASSERT_TRUE(decoded.complete || decoded.error->code == ErrorCode::BadChunk);
                ASSERT_NO_FATAL_FAILURE(expect_valid(decoded.last, good.info.grid.bits));
            }
        }
    }
    EXPECT_GT(refused, 10 * accepted);
}

TEST_P(Hostile, RejectsChunksOfEveryOtherLength)
{
    const StreamParts good = take_apart(sample().file);
    for (std::size_t c = 0; c < good.chunks.size(); ++c)
    {
        for (std::size_t length = 0; length < good.chunks[c].size(); ++length)
        {
            StreamParts parts = good;
            parts.chunks[c].resize(length);
            const Decoded decoded = decode(put_together(parts));
            ASSERT_TRUE(decoded.error.has_value()) << "chunk " << c << " of length " << length;
        }
        for (const std::size_t more : {1U, 2U, 5U})
        {
            StreamParts parts = good;
            parts.chunks[c].resize(good.chunks[c].size() + more);
            const Decoded decoded = decode(put_together(parts));
            ASSERT_TRUE(decoded.error.has_value()) << "chunk " << c << " with " << more << " more";
        }
    }
}

TEST_P(Hostile, RejectsCountsThatAreNotThoseOfTheChunks)
{
    const StreamParts good = take_apart(sample().file);
    for (std::size_t c = 0; c + 1 < good.chunks.size(); ++c)
    {
        for (const std::uint32_t vertices : {0xFFFFFFFFU, 0U, 1U})
        {
            for (const std::uint32_t faces : {0xFFFFFFFFU, 0U, 1U})
            {
                StreamParts parts = good;
                parts.info.chunks[c].vertices += vertices;
                parts.info.chunks[c].faces += faces;
                EXPECT_EQ(decode(put_together(parts)).complete, vertices == 0 && faces == 0);
            }
        }
    }
}

TEST_P(Hostile, KeepsItsMeshAndItsErrorAfterADamagedChunk)
{
    const Decoded good = decode(sample().file);
    for (std::size_t c = 0; c < good.chunks.size(); ++c)
    {
        Bytes damaged = sample().file;
        damaged[static_cast<std::size_t>(sample().info.chunks[c].offset)] ^= std::byte{1};
        StreamDecoder decoder;
        std::span<const std::byte> rest = damaged;
        auto step = decoder.step();
        while (step)
        {
            rest = rest.subspan(decoder.feed(rest).value());
            step = decoder.step();
        }
        EXPECT_EQ(step.error().code, ErrorCode::BadChecksum);
        EXPECT_EQ(step.error().offset, sample().info.chunks[c].offset);
        EXPECT_EQ(decoder.decoded_bytes(), sample().info.chunks[c].offset);
        EXPECT_EQ(decoder.wanted_bytes(), 0U);
        for (int again = 0; again < 2; ++again)
        {
            EXPECT_EQ(decoder.step().error().message, step.error().message);
            EXPECT_EQ(decoder.feed(rest).error().message, step.error().message);
        }
        EXPECT_EQ(decoder.vertices(), c == 0 ? 0 : sample().info.chunks[c - 1].vertices);
        EXPECT_TRUE(c == 0 || snapshot(decoder) == good.chunks[c - 1]);
    }
}

TEST_P(Hostile, ShowsNothingOfABaseThatIsRefused)
{
    const StreamParts good = take_apart(sample().file);
    for (std::size_t i = 0; i < good.chunks[0].size(); ++i)
    {
        StreamParts parts = good;
        parts.chunks[0][i] ^= std::byte{0x21};
        const Bytes file = put_together(parts);
        StreamDecoder decoder;
        std::span<const std::byte> rest = file;
        rest = rest.subspan(decoder.feed(rest).value());
        rest = rest.subspan(decoder.feed(rest).value());
        ASSERT_EQ(decoder.step().value().kind, codec::StepKind::Header);
        rest = rest.subspan(decoder.feed(rest).value());
        if (!decoder.step())
        {
            EXPECT_EQ(decoder.vertices(), 0U);
            EXPECT_EQ(decoder.faces(), 0U);
        }
    }
}

/// Puts an optional chunk of an unknown kind in front of chunk number `place`.
StreamParts with_optional(const StreamParts& good, std::size_t place, bool ends_level)
{
    StreamParts parts = good;
    const auto at = static_cast<std::ptrdiff_t>(place);
    ChunkInfo row = good.info.chunks[place - 1];
    row.kind = static_cast<ChunkKind>(100);
    row.codec = 3;
    row.ends_level = ends_level;
    parts.info.chunks.insert(parts.info.chunks.begin() + at, row);
    parts.chunks.insert(parts.chunks.begin() + at, Bytes(17, std::byte{0x77}));
    return parts;
}

TEST_P(Hostile, SkipsOptionalChunksAnywhere)
{
    const StreamParts good = take_apart(sample().file);
    const Decoded wanted = decode(sample().file);
    for (std::size_t place = 1; place <= good.chunks.size(); ++place)
    {
        for (const bool ends_level : {false, true})
        {
            SCOPED_TRACE(place);
            const Decoded decoded = decode(put_together(with_optional(good, place, ends_level)));
            ASSERT_FALSE(decoded.error.has_value()) << describe(*decoded.error);
            EXPECT_TRUE(decoded.complete);
            EXPECT_EQ(decoded.chunks, wanted.chunks);
            EXPECT_EQ(decoded.levels, wanted.levels);
            EXPECT_EQ(decoded.stitches, wanted.stitches);
        }
    }
}

TEST_P(Hostile, SkipsOptionalChunksOnlyWhenTheyAreWhole)
{
    Bytes file = put_together(with_optional(take_apart(sample().file), 1, true));
    const auto info = codec::parse_stream_info(file).value();
    file[static_cast<std::size_t>(info.chunks[1].offset)] ^= std::byte{1};
    EXPECT_EQ(decode(file).error.value().code, ErrorCode::BadChecksum);
}

TEST_P(Hostile, RefusesUnknownRequiredChunks)
{
    StreamParts parts = with_optional(take_apart(sample().file), 2, true);
    parts.info.chunks[2].kind = static_cast<ChunkKind>(7);
    EXPECT_EQ(decode(put_together(parts)).error.value().code, ErrorCode::UnknownRequiredChunk);
    parts.info.chunks[2].kind = ChunkKind::Batch;  // with codec 3
    EXPECT_EQ(decode(put_together(parts)).error.value().code, ErrorCode::UnknownRequiredChunk);
}

TEST_P(Hostile, RefusesWhatIsBeyondItsLimits)
{
    const codec::StreamInfo& info = sample().info;
    std::uint32_t largest = 0;
    for (const ChunkInfo& chunk : info.chunks)
    {
        largest = std::max(largest, chunk.bytes);
    }
    const std::vector<codec::DecodeLimits> limits{
        {.max_vertices = info.vertex_count - 1},
        {.max_faces = info.face_count - 1},
        {.max_header_bytes = info.header_bytes - 1},
        {.max_chunk_bytes = largest - 1},
        {.max_heap_bytes = codec::decoder_heap_bytes(info) - 1},
    };
    for (const codec::DecodeLimits& limit : limits)
    {
        const Decoded decoded = decode(sample().file, limit);
        ASSERT_TRUE(decoded.error.has_value());
        EXPECT_EQ(decoded.error->code, ErrorCode::LimitExceeded);
        EXPECT_TRUE(decoded.chunks.empty());
    }
}

TEST(StitchChunk, IsRefusedBeforeTheLastLevel)
{
    StreamParts parts = take_apart(encode(book(7)).file);
    ASSERT_EQ(parts.info.chunks.back().kind, ChunkKind::Stitch);
    std::rotate(
        parts.info.chunks.begin() + 1, parts.info.chunks.end() - 1, parts.info.chunks.end()
    );
    std::rotate(parts.chunks.begin() + 1, parts.chunks.end() - 1, parts.chunks.end());
    parts.info.chunks[1].vertices = parts.info.chunks[0].vertices;
    parts.info.chunks[1].faces = parts.info.chunks[0].faces;
    EXPECT_EQ(decode(put_together(parts)).error.value().code, ErrorCode::BadChunk);
}

TEST(StitchChunk, OfAnotherCodecIsSkipped)
{
    StreamParts parts = take_apart(encode(book(7)).file);
    parts.info.chunks.back().codec = 1;
    const Decoded decoded = decode(put_together(parts));
    EXPECT_TRUE(decoded.complete);
    EXPECT_TRUE(decoded.stitches.empty());
}

TEST(StitchChunk, RestoresTheVerticesThatRepairCut)
{
    const EncodedSample sample = encode(book(7));
    const Decoded decoded = decode(sample.file);
    ASSERT_EQ(decoded.stitches.size(), sample.info.vertex_count);
    // By position, because the stream numbers vertices anew; at the spine all copies are one.
    const auto& positions = decoded.levels.back().mesh.positions;
    std::size_t one_with_another = 0;
    for (std::uint32_t v = 0; v < decoded.stitches.size(); ++v)
    {
        const std::uint32_t other = decoded.stitches[v];
        ASSERT_LE(other, v);
        EXPECT_EQ(decoded.stitches[other], other);
        EXPECT_EQ(positions[other], positions[v]);
        one_with_another += other == v ? 0 : 1;
    }
    std::size_t wanted = 0;
    for (std::uint32_t v = 0; v < sample.stitches.size(); ++v)
    {
        wanted += sample.stitches[v] == v ? 0 : 1;
    }
    EXPECT_EQ(one_with_another, wanted);
    EXPECT_GT(wanted, 0U);
}

}  // namespace
}  // namespace vsplit::test
