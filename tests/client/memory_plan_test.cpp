#include "memory_plan.h"

#include "encoded_torus.h"
#include "gl_textures.h"
#include "gpu_buffers.h"
#include "image/texture_layout.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace vsplit::client {
namespace {

constexpr std::uint32_t kAnyLevel = std::numeric_limits<std::uint32_t>::max();

TEST(MemoryPlan, TakesEveryLevelWhenThereIsRoom)
{
    const codec::StreamInfo& info = encoded_torus().info;
    const auto plan = plan_memory(info, kAnyLevel, {std::uint64_t{1} << 30, 65536, false});
    ASSERT_TRUE(plan.has_value());
    EXPECT_EQ(plan->level, info.levels.back().level);
    EXPECT_EQ(
        plan->needed_bytes,
        codec::decoder_heap_bytes(info) + 65536 +
            GpuBuffers::memory_bytes(info.vertex_count, info.face_count, false)
    );
}

TEST(MemoryPlan, NeverExceedsTheCapAndUsesIt)
{
    const codec::StreamInfo& info = encoded_torus().info;
    const auto whole = plan_memory(info, kAnyLevel, {std::uint64_t{1} << 30, 4096, true});
    ASSERT_TRUE(whole.has_value());
    std::uint32_t previous = 0;
    bool fitted = false;
    for (std::uint64_t cap = 0; cap <= whole->needed_bytes; cap += whole->needed_bytes / 97)
    {
        const auto plan = plan_memory(info, kAnyLevel, {cap, 4096, true});
        if (!plan)
        {
            EXPECT_FALSE(fitted) << "a larger device shows less";
            EXPECT_EQ(plan.error().code, ErrorCode::LimitExceeded);
            continue;
        }
        fitted = true;
        EXPECT_LE(plan->needed_bytes, cap);
        EXPECT_GE(plan->level, previous);
        previous = plan->level;
        if (plan->level < info.levels.back().level)
        {
            const auto finer =
                plan_memory(info, plan->level + 1, {std::uint64_t{1} << 30, 4096, true});
            EXPECT_GT(finer->needed_bytes, cap);
        }
    }
    EXPECT_TRUE(fitted);
}

TEST(MemoryPlan, DoesNotGoBeyondTheLevelThatIsWanted)
{
    const auto plan = plan_memory(encoded_torus().info, 2, {std::uint64_t{1} << 30, 4096, false});
    ASSERT_TRUE(plan.has_value());
    EXPECT_EQ(plan->level, 2U);
}

// The torus with two images of 1024 and 4096 pixels, as the tags of their chunks say.
codec::StreamInfo with_textures()
{
    codec::StreamInfo info = encoded_torus().info;
    for (const auto& [image, groups] : {std::pair{0U, 3U}, std::pair{1U, 5U}})
    {
        for (unsigned group = 0; group < groups; ++group)
        {
            codec::ChunkInfo chunk = info.chunks.front();
            chunk.kind = proto::ChunkKind::Texture;
            chunk.bytes = 1000;
            chunk.tag = image::texture_tag(image, group);
            info.chunks.insert(info.chunks.begin() + 1, chunk);
        }
    }
    return info;
}

TEST(MemoryPlan, CountsTexturesByWhatTheirTagsSay)
{
    const codec::StreamInfo info = with_textures();
    EXPECT_EQ(texture_memory_bytes(info, 0), 0U);
    EXPECT_EQ(texture_memory_bytes(encoded_torus().info, 4096), 0U);
    const std::uint64_t small = texture_memory_bytes(info, 256);
    EXPECT_GE(small, 2 * texture_bytes(256, 256) + 2000);
    const std::uint64_t large = texture_memory_bytes(info, 4096);
    EXPECT_GE(large, texture_bytes(1024, 1024) + texture_bytes(4096, 4096) + 8000);
    EXPECT_GE(large, texture_memory_bytes(info, 2048));
    EXPECT_GE(texture_memory_bytes(info, 2048), texture_memory_bytes(info, 1024));
}

TEST(MemoryPlan, HalvesTheTexturesBeforeItGivesUpALevel)
{
    const codec::StreamInfo info = with_textures();
    MemoryUse use;
    use.cap_bytes = std::uint64_t{1} << 40;
    use.queue_bytes = 4096;
    use.surface = true;
    use.texture_limit = 4096;
    const auto whole = plan_memory(info, kAnyLevel, use);
    ASSERT_TRUE(whole.has_value());
    EXPECT_EQ(whole->texture_limit, 4096U);
    EXPECT_EQ(whole->texture_bytes, texture_memory_bytes(info, 4096));
    std::uint32_t limit = 4096;
    std::uint32_t level = info.levels.back().level;
    for (use.cap_bytes = whole->needed_bytes; use.cap_bytes > 0;
         use.cap_bytes -= use.cap_bytes / 8 + 1)
    {
        const auto plan = plan_memory(info, kAnyLevel, use);
        if (!plan)
        {
            EXPECT_EQ(plan.error().code, ErrorCode::LimitExceeded);
            break;
        }
        EXPECT_LE(plan->needed_bytes, use.cap_bytes);
        EXPECT_LE(plan->level, level);
        EXPECT_TRUE(plan->level < level || plan->texture_limit <= limit);
        EXPECT_TRUE(plan->texture_limit >= 256 || plan->level == 0);
        limit = plan->texture_limit;
        level = plan->level;
    }
    EXPECT_EQ(level, 0U);
    EXPECT_EQ(limit, 0U) << "in the end the shape is all";
}

}  // namespace
}  // namespace vsplit::client
