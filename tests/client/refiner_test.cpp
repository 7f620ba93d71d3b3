#include "refiner.h"

#include "encoded_torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace vsplit::client {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kLongBudget{3600.0};

// The arrays as they would be built from the decoder's mesh at once.
GpuBuffers rebuild(const codec::StreamDecoder& decoder)
{
    std::vector<Triangle> triangles(decoder.faces());
    decoder.write_triangles(triangles);
    std::vector<codec::TriangleUpdate> updates;
    for (std::uint32_t slot = 0; slot < triangles.size(); ++slot)
    {
        updates.push_back({slot, triangles[slot]});
    }
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.vertices = decoder.vertices();
    step.faces = decoder.faces();
    step.triangles = updates;
    GpuBuffers buffers(decoder.info()->diagonal());
    buffers.apply(step, [&](std::uint32_t first, std::uint32_t count, std::span<float> out) {
        decoder.write_positions(first, count, out);
    });
    return buffers;
}

// Feeds and advances until advance() reports a level or nothing is left.
Result<Progress> next_level(Refiner& refiner, std::span<const std::byte>& bytes)
{
    while (true)
    {
        const auto taken = refiner.feed(bytes);
        VSPLIT_TRY(taken);
        bytes = bytes.subspan(*taken);
        auto progress = refiner.advance(kLongBudget);
        if (!progress || progress->level_complete || (bytes.empty() && !progress->changed))
        {
            return progress;
        }
    }
}

TEST(Refiner, KeepsArraysThatEqualARebuildAtEveryLevel)
{
    const TestStream& stream = encoded_torus();
    Refiner refiner(stream.info, {});
    std::span<const std::byte> bytes = stream.file;
    for (const codec::LevelInfo& level : stream.info.levels)
    {
        SCOPED_TRACE(level.level);
        const auto progress = next_level(refiner, bytes);
        ASSERT_TRUE(progress.has_value()) << describe(progress.error());
        ASSERT_TRUE(progress->level_complete);
        ASSERT_EQ(refiner.decoder().level(), level.level);
        ASSERT_EQ(refiner.buffers().vertices().size(), level.vertices);
        ASSERT_EQ(refiner.buffers().triangles().size(), level.faces);
        const GpuBuffers expected = rebuild(refiner.decoder());
        ASSERT_TRUE(std::ranges::equal(refiner.buffers().vertices(), expected.vertices()));
        ASSERT_TRUE(std::ranges::equal(refiner.buffers().triangles(), expected.triangles()));
    }
    EXPECT_TRUE(refiner.decoder().complete());
    EXPECT_GT(stream.info.levels.size(), 5U);
}

TEST(Refiner, AppliesOneChunkWhenThereIsNoTime)
{
    const TestStream& stream = encoded_torus();
    Refiner refiner(stream.info, {});
    std::span<const std::byte> bytes = stream.file;
    std::uint64_t applied = stream.info.header_bytes;
    for (const codec::ChunkInfo& chunk : stream.info.chunks)
    {
        Progress progress;
        while (progress.bytes.sum() == 0)
        {
            const auto taken = refiner.feed(bytes);
            ASSERT_TRUE(taken.has_value());
            bytes = bytes.subspan(*taken);
            const auto advanced = refiner.advance(Seconds(0));
            ASSERT_TRUE(advanced.has_value());
            progress = *advanced;
        }
        applied += chunk.bytes;
        EXPECT_EQ(progress.bytes.sum(), chunk.bytes);
        EXPECT_EQ(refiner.decoder().decoded_bytes(), applied);
    }
}

TEST(Refiner, RefusesLevelsBeyondItsLimit)
{
    const TestStream& stream = encoded_torus();
    codec::DecodeLimits limits;
    limits.max_level = 3;
    const codec::StreamInfo prefix = codec::prefix_info(stream.info, 3);
    EXPECT_EQ(prefix.file_bytes, stream.info.levels[3].cumulative_bytes);
    limits.max_heap_bytes = codec::decoder_heap_bytes(prefix);
    ASSERT_LT(limits.max_heap_bytes, codec::decoder_heap_bytes(stream.info));
    Refiner refiner(prefix, limits);
    std::span<const std::byte> bytes = stream.file;
    for (int level = 0; level <= 3; ++level)
    {
        const auto progress = next_level(refiner, bytes);
        ASSERT_TRUE(progress.has_value()) << describe(progress.error());
    }
    EXPECT_EQ(refiner.decoder().faces(), prefix.face_count);
    const auto refused = next_level(refiner, bytes);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
}

TEST(Refiner, ReportsDamageAndKeepsTheMeshBeforeIt)
{
    TestStream stream = encoded_torus();
    const codec::LevelInfo& damaged = stream.info.levels[4];
    const codec::LevelInfo good = stream.info.levels[3];
    stream.file[damaged.cumulative_bytes - damaged.chunk_bytes / 2] ^= std::byte{0x10};
    Refiner refiner(stream.info, {});
    std::span<const std::byte> bytes = stream.file;
    for (int level = 0; level < 4; ++level)
    {
        ASSERT_TRUE(next_level(refiner, bytes).has_value());
    }
    const auto failed = next_level(refiner, bytes);
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().code, ErrorCode::BadChecksum);
    EXPECT_EQ(refiner.buffers().triangles().size(), good.faces);
    const GpuBuffers expected = rebuild(refiner.decoder());
    EXPECT_TRUE(std::ranges::equal(refiner.buffers().vertices(), expected.vertices()));
    EXPECT_FALSE(refiner.feed(bytes).has_value());
    EXPECT_FALSE(refiner.advance(kLongBudget).has_value());
}

}  // namespace
}  // namespace vsplit::client
