#include "codec/stream_info.h"

#include "codec/stream_header_writer.h"

#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using codec::parse_stream_info;
using codec::prefix_info;
using codec::stop_offset;
using codec::StreamInfo;
using proto::ChunkKind;

/// Levels of 100, 40 + 60 (an optional chunk between them), 80 and 90 bytes, stitches at the end.
StreamInfo sample()
{
    StreamInfo info;
    info.grid.bits = 10;
    info.chunks = {
        {.kind = ChunkKind::Base, .bytes = 100, .vertices = 10, .faces = 16, .rms_error = 80.0},
        {.ends_level = false, .bytes = 40, .vertices = 20, .faces = 36},
        {.kind = static_cast<ChunkKind>(99), .bytes = 11, .vertices = 20, .faces = 36},
        {.bytes = 60, .vertices = 30, .faces = 56, .rms_error = 40.0},
        {.bytes = 80, .vertices = 60, .faces = 116, .rms_error = 20.0},
        {.bytes = 90, .vertices = 90, .faces = 176, .rms_error = 10.0},
        {.kind = ChunkKind::Stitch, .bytes = 13, .vertices = 90, .faces = 176},
    };
    info.vertex_count = 90;
    info.face_count = 176;
    return parse_stream_info(codec::write_stream_header(info, {1000, 1000, 1000})).value();
}

TEST(StopOffset, IsTheWholeFileWithoutACondition)
{
    const StreamInfo info = sample();
    EXPECT_EQ(stop_offset(info, {}), info.file_bytes);
}

TEST(StopOffset, EndsAtALevel)
{
    const StreamInfo info = sample();
    for (std::uint32_t level = 0; level < info.levels.size(); ++level)
    {
        EXPECT_EQ(stop_offset(info, {.level = level}), info.levels[level].cumulative_bytes);
    }
    EXPECT_EQ(stop_offset(info, {.level = 100}), info.file_bytes);
}

TEST(StopOffset, NeverExceedsTheBytesBeyondTheBase)
{
    const StreamInfo info = sample();
    const std::uint64_t base = info.levels[0].cumulative_bytes;
    for (std::uint64_t bytes = 0; bytes <= info.file_bytes; ++bytes)
    {
        const std::uint64_t offset = stop_offset(info, {.bytes = bytes});
        EXPECT_LE(offset, std::max(bytes, base));
        EXPECT_GE(offset, base);
    }
    EXPECT_EQ(stop_offset(info, {.bytes = info.file_bytes}), info.file_bytes);
}

TEST(StopOffset, NeverExceedsTheFacesBeyondTheBase)
{
    const StreamInfo info = sample();
    EXPECT_EQ(stop_offset(info, {.faces = 0}), info.levels[0].cumulative_bytes);
    EXPECT_EQ(stop_offset(info, {.faces = 55}), info.chunks[2].offset + 11);
    EXPECT_EQ(stop_offset(info, {.faces = 116}), info.levels[2].cumulative_bytes);
}

TEST(StopOffset, EndsAtTheFirstLevelThatIsGoodEnough)
{
    const StreamInfo info = sample();
    EXPECT_EQ(stop_offset(info, {.error = 1000.0}), info.levels[0].cumulative_bytes);
    EXPECT_EQ(stop_offset(info, {.error = 45.0}), info.levels[1].cumulative_bytes);
    EXPECT_EQ(stop_offset(info, {.error = 0.001}), info.file_bytes);
}

TEST(PrefixInfo, IsWhatTheHeaderOfThePrefixWouldSay)
{
    const StreamInfo info = sample();
    const StreamInfo prefix = prefix_info(info, 1);
    EXPECT_EQ(prefix.vertex_count, 30U);
    EXPECT_EQ(prefix.face_count, 56U);
    EXPECT_EQ(prefix.levels.size(), 2U);
    EXPECT_EQ(prefix.chunks.size(), 4U);
    EXPECT_EQ(prefix.file_bytes, info.levels[1].cumulative_bytes);
    EXPECT_EQ(prefix_info(info, 0).chunks.size(), 1U);
    EXPECT_EQ(prefix_info(info, 3).chunks.size(), info.chunks.size());
    EXPECT_EQ(prefix_info(info, 4000000000U).chunks.size(), info.chunks.size());
}

TEST(PrefixInfo, LeavesAWedgeForEveryVertexToCome)
{
    StreamInfo info = sample();
    info.wedge_count = 120;
    EXPECT_EQ(prefix_info(info, 2).wedge_count, 90U);  // 60 vertices, 30 to come
    EXPECT_EQ(prefix_info(info, 3).wedge_count, 120U);
    info.wedge_count = 0;
    EXPECT_EQ(prefix_info(info, 1).wedge_count, 0U);
}

TEST(DecoderHeapBytes, CountAttributesThatAreDecoded)
{
    StreamInfo info = sample();
    const std::uint64_t bare = codec::decoder_heap_bytes(info);
    info.wedge_count = 120;
    info.attributes.resize(1);
    info.chunks[5].kind = ChunkKind::Attributes;
    const std::uint64_t one = codec::decoder_heap_bytes(info);
    EXPECT_GT(one, bare);
    info.attributes.resize(2);
    EXPECT_GT(codec::decoder_heap_bytes(info), one);
    EXPECT_LT(codec::decoder_heap_bytes(codec::without_attributes(info)), one);
}

TEST(DecoderHeapBytes, GrowWithTheLevel)
{
    const StreamInfo info = sample();
    for (std::uint32_t level = 0; level + 1 < info.levels.size(); ++level)
    {
        EXPECT_LT(
            codec::decoder_heap_bytes(prefix_info(info, level)),
            codec::decoder_heap_bytes(prefix_info(info, level + 1))
        );
    }
}

}  // namespace
}  // namespace vsplit::test
