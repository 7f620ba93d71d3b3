#include "codec/stream_decoder.h"

#include "codec/encoded_samples.h"
#include "codec/shapes.h"
#include "codec/stream_parts.h"
#include "precompute/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace vsplit::test {
namespace {

using codec::Step;
using codec::StepKind;
using codec::StreamDecoder;

class EveryStream : public ::testing::TestWithParam<NamedMesh>
{
protected:
    void SetUp() override { sample_ = encode(GetParam().make()); }

    [[nodiscard]] const EncodedSample& sample() const { return sample_; }

private:
    EncodedSample sample_;
};

INSTANTIATE_TEST_SUITE_P(
    Small,
    EveryStream,
    ::testing::ValuesIn(small_meshes()),
    [](const auto& instance) { return instance.param.name; }
);

TEST_P(EveryStream, DecodesToExactlyTheSource)
{
    const Decoded decoded = decode(sample().file);
    ASSERT_TRUE(decoded.complete);
    const Snapshot& last = decoded.levels.back();
    EXPECT_EQ(last.shift, 0);
    EXPECT_EQ(face_set(last.mesh), face_set(sample().source));
    auto wanted = sample().source.positions;
    auto positions = last.mesh.positions;
    std::ranges::sort(wanted);
    std::ranges::sort(positions);
    EXPECT_EQ(positions, wanted);
}

TEST_P(EveryStream, AgreesWithItsIndex)
{
    const codec::StreamInfo& info = sample().info;
    StreamDecoder decoder;
    std::span<const std::byte> rest = sample().file;
    std::size_t level = 0;
    for (Step step; !decoder.complete();)
    {
        rest = rest.subspan(decoder.feed(rest).value());
        step = decoder.step().value();
        EXPECT_EQ(decoder.received_bytes(), sample().file.size() - rest.size());
        EXPECT_TRUE(
            step.kind == StepKind::NeedBytes || decoder.decoded_bytes() == decoder.received_bytes()
        );
        EXPECT_EQ(step.vertices, decoder.vertices());
        EXPECT_EQ(step.faces, decoder.faces());
        if (step.level_complete)
        {
            ASSERT_LT(level, info.levels.size());
            EXPECT_EQ(step.level, level);
            EXPECT_EQ(decoder.level(), level);
            EXPECT_EQ(step.vertices, info.levels[level].vertices);
            EXPECT_EQ(step.faces, info.levels[level].faces);
            const bool last = level + 1 == info.levels.size();
            EXPECT_TRUE(last || decoder.decoded_bytes() == info.levels[level].cumulative_bytes);
            ++level;
        }
    }
    EXPECT_EQ(level, info.levels.size());
    EXPECT_EQ(decoder.decoded_bytes(), info.file_bytes);
    EXPECT_EQ(decoder.received_bytes(), info.file_bytes);
    EXPECT_EQ(sample().file.size(), info.file_bytes);
}

TEST_P(EveryStream, GivesTheSameFedByteByByte)
{
    const Decoded at_once = decode(sample().file);
    StreamDecoder decoder;
    std::vector<Snapshot> chunks;
    for (std::size_t i = 0; i < sample().file.size(); ++i)
    {
        ASSERT_EQ(decoder.feed(std::span(sample().file).subspan(i, 1)).value(), 1U);
        EXPECT_EQ(decoder.received_bytes(), i + 1);
        Step step = decoder.step().value();
        EXPECT_TRUE(step.kind == StepKind::NeedBytes || decoder.decoded_bytes() == i + 1);
        if (step.kind == StepKind::Chunk)
        {
            chunks.push_back(snapshot(decoder));
        }
    }
    EXPECT_TRUE(decoder.complete());
    EXPECT_EQ(chunks, at_once.chunks);
    EXPECT_EQ(decoder.step().value().kind, StepKind::Complete);
}

TEST_P(EveryStream, AsksForExactlyTheBytesOfTheNextPiece)
{
    StreamDecoder decoder;
    std::size_t fed = 0;
    while (!decoder.complete())
    {
        if (decoder.wanted_bytes() == 0)
        {
            EXPECT_NE(decoder.step().value().kind, StepKind::NeedBytes);
            continue;
        }
        EXPECT_EQ(decoder.step().value().kind, StepKind::NeedBytes);
        const std::size_t wanted = decoder.wanted_bytes();
        const auto bytes = std::span(sample().file).subspan(fed, wanted);
        ASSERT_EQ(decoder.feed(bytes).value(), wanted);
        fed += wanted;
    }
    EXPECT_EQ(fed, sample().file.size());
    EXPECT_EQ(decoder.wanted_bytes(), 0U);
}

/// What a caller keeps that only listens to the steps.
struct Mirror
{
    std::vector<std::array<std::int32_t, 3>> positions;
    std::vector<Triangle> triangles;

    void follow(const StreamDecoder& decoder, const Step& step)
    {
        ASSERT_LE(step.first_moved_vertex, step.first_new_vertex);
        ASSERT_TRUE(step.kind != StepKind::Chunk || step.first_new_vertex == positions.size());
        positions.resize(step.vertices);
        for (std::uint32_t v = step.first_moved_vertex; v < step.vertices; ++v)
        {
            positions[v] = decoder.grid_position(v);
        }
        triangles.resize(step.faces, Triangle{0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF});
        for (const codec::TriangleUpdate& update : step.triangles)
        {
            ASSERT_LT(update.slot, triangles.size());
            triangles[update.slot] = update.vertices;
        }
        if (step.triangles_replaced)
        {
            decoder.write_triangles(triangles);
        }
    }
};

TEST_P(EveryStream, TellsEveryChangeInItsSteps)
{
    StreamDecoder decoder;
    Mirror mirror;
    std::span<const std::byte> rest = sample().file;
    while (!decoder.complete())
    {
        rest = rest.subspan(decoder.feed(rest).value());
        const Step step = decoder.step().value();
        mirror.follow(decoder, step);
        const Snapshot shown = snapshot(decoder);
        ASSERT_EQ(mirror.triangles, shown.mesh.triangles);
        ASSERT_EQ(mirror.positions, shown.mesh.positions);
    }
}

TEST_P(EveryStream, ShowsAManifoldAfterEveryChunk)
{
    for (const Snapshot& shown : decode(sample().file).chunks)
    {
        IndexedMesh mesh{{}, shown.mesh.triangles};
        mesh.positions.resize(shown.mesh.positions.size());
        const auto checked = precompute::check_manifold(mesh);
        ASSERT_TRUE(checked.has_value()) << describe(checked.error());
    }
}

TEST_P(EveryStream, ShowsVerticesNearThoseOfTheSource)
{
    const Decoded decoded = decode(sample().file);
    const auto& last = decoded.levels.back().mesh.positions;
    // Coarse levels may show a vertex in another cell than its own, where the surface is better.
    constexpr std::int32_t kFarthest = 16;
    int shift = 32;
    for (const Snapshot& shown : decoded.chunks)
    {
        EXPECT_LE(shown.shift, shift);
        shift = shown.shift;
        const std::int32_t most = shift == 0 ? 0 : kFarthest;
        for (std::size_t v = 0; v < shown.mesh.positions.size(); ++v)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                ASSERT_NEAR(shown.mesh.positions[v][axis], last[v][axis] >> shift, most);
            }
        }
    }
}

TEST_P(EveryStream, WritesPositionsInModelUnits)
{
    StreamDecoder decoder;
    std::span<const std::byte> rest = sample().file;
    while (!decoder.complete())
    {
        rest = rest.subspan(decoder.feed(rest).value());
        static_cast<void>(decoder.step().value());
        const std::uint32_t half = decoder.vertices() / 2;
        std::vector<float> out(3ULL * (decoder.vertices() - half));
        decoder.write_positions(half, decoder.vertices() - half, out);
        for (std::uint32_t v = half; v < decoder.vertices(); ++v)
        {
            const auto point =
                dequantize(sample().info.grid, decoder.grid_position(v), decoder.shift());
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                ASSERT_EQ(out[3ULL * (v - half) + axis], static_cast<float>(point[axis]));
            }
        }
    }
}

TEST_P(EveryStream, IsTheSameForAnyNumberOfThreads)
{
    for (const unsigned threads : {1U, 2U, 5U})
    {
        EXPECT_EQ(encode(GetParam().make(), {.threads = threads}).file, sample().file);
    }
}

TEST_P(EveryStream, ShowsThePrefixOfEveryTruncation)
{
    const Decoded whole = decode(sample().file);
    for (std::size_t length = 0; length < sample().file.size(); ++length)
    {
        const Decoded part = decode(std::span(sample().file).first(length));
        ASSERT_FALSE(part.complete) << length;
        ASSERT_FALSE(part.error.has_value()) << length;
        EXPECT_EQ(part.taken, length);
        std::size_t chunks = 0;
        for (const codec::ChunkInfo& chunk : sample().info.chunks)
        {
            chunks += chunk.offset + chunk.bytes <= length ? 1 : 0;
        }
        ASSERT_EQ(part.chunks.size(), chunks);
        ASSERT_TRUE(chunks == 0 || part.chunks.back() == whole.chunks[chunks - 1]);
    }
}

TEST_P(EveryStream, TakesNoTrailingBytes)
{
    Bytes longer = sample().file;
    longer.resize(longer.size() + 20, std::byte{0x55});
    const Decoded decoded = decode(longer);
    EXPECT_TRUE(decoded.complete);
    EXPECT_EQ(decoded.taken, sample().file.size());
}

TEST_P(EveryStream, DecodesTheSameWithinExactlyItsLimits)
{
    const codec::StreamInfo& info = sample().info;
    std::uint32_t largest = 0;
    for (const codec::ChunkInfo& chunk : info.chunks)
    {
        largest = std::max(largest, chunk.bytes);
    }
    const codec::DecodeLimits limits{
        .max_vertices = info.vertex_count,
        .max_faces = info.face_count,
        .max_header_bytes = info.header_bytes,
        .max_chunk_bytes = largest,
        .max_heap_bytes = codec::decoder_heap_bytes(info),
    };
    EXPECT_EQ(decode(sample().file, limits).chunks, decode(sample().file).chunks);
}

TEST_P(EveryStream, StopsAtTheGreatestLevelAllowed)
{
    const Decoded whole = decode(sample().file);
    for (std::uint32_t level = 0; level + 1 < sample().info.levels.size(); ++level)
    {
        const codec::StreamInfo prefix = codec::prefix_info(sample().info, level);
        const Decoded part = decode(
            sample().file, {.max_heap_bytes = codec::decoder_heap_bytes(prefix), .max_level = level}
        );
        ASSERT_TRUE(part.error.has_value());
        EXPECT_EQ(part.error->code, ErrorCode::LimitExceeded);
        ASSERT_EQ(part.levels.size(), level + 1U);
        EXPECT_EQ(part.levels.back(), whole.levels[level]);
    }
}

}  // namespace
}  // namespace vsplit::test
