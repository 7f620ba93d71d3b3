#include "memory_plan.h"

#include "encoded_torus.h"
#include "gpu_buffers.h"

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace vsplit::client
