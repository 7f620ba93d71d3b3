#include "fetch_plan.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace vsplit::client {
namespace {

using proto::ChunkKind;

// Header of 100 bytes, then chunks one after the other.
codec::StreamInfo stream_of(const std::vector<std::pair<ChunkKind, std::uint32_t>>& chunks)
{
    codec::StreamInfo info;
    info.header_bytes = 100;
    info.file_bytes = 100;
    for (const auto& [kind, bytes] : chunks)
    {
        codec::ChunkInfo chunk;
        chunk.kind = kind;
        chunk.offset = info.file_bytes;
        chunk.bytes = bytes;
        info.chunks.push_back(chunk);
        info.file_bytes += bytes;
    }
    return info;
}

bool nothing(const codec::ChunkInfo& /*chunk*/)
{
    return false;
}

TEST(FetchPlan, LeavesOutOptionalChunksOnlyAndKeepsStitches)
{
    const codec::StreamInfo info = stream_of(
        {{ChunkKind::Base, 10},
         {ChunkKind::Attributes, 20},
         {ChunkKind::Batch, 30},
         {ChunkKind::Stitch, 40},
         {ChunkKind::Texture, 50}}
    );
    EXPECT_EQ(
        unwanted_chunks(info, nothing, info.file_bytes, 0),
        (std::vector<ByteRange>{{110, 130}, {200, 250}})
    );
    const auto attributes = [](const codec::ChunkInfo& chunk) {
        return chunk.kind == ChunkKind::Attributes;
    };
    EXPECT_EQ(
        unwanted_chunks(info, attributes, info.file_bytes, 0), (std::vector<ByteRange>{{200, 250}})
    );
}

TEST(FetchPlan, FetchesWhatIsTooShortToLeaveOut)
{
    const codec::StreamInfo info = stream_of(
        {{ChunkKind::Base, 10},
         {ChunkKind::Texture, 20},
         {ChunkKind::Texture, 30},
         {ChunkKind::Batch, 30},
         {ChunkKind::Texture, 40}}
    );
    EXPECT_EQ(
        unwanted_chunks(info, nothing, info.file_bytes, 50),
        (std::vector<ByteRange>{{110, 130}, {130, 160}})
    );
    EXPECT_EQ(
        unwanted_chunks(info, nothing, info.file_bytes, 40),
        (std::vector<ByteRange>{{110, 130}, {130, 160}, {190, 230}})
    );
    EXPECT_TRUE(unwanted_chunks(info, nothing, info.file_bytes, 51).empty());
}

TEST(FetchPlan, DoesNotLookBeyondTheEnd)
{
    const codec::StreamInfo info =
        stream_of({{ChunkKind::Base, 10}, {ChunkKind::Texture, 20}, {ChunkKind::Texture, 30}});
    EXPECT_EQ(unwanted_chunks(info, nothing, 130, 0), (std::vector<ByteRange>{{110, 130}}));
    EXPECT_TRUE(unwanted_chunks(info, nothing, 110, 0).empty());
}

}  // namespace
}  // namespace vsplit::client
