#include "codec/item_stacks.h"

#include <gtest/gtest.h>

namespace vsplit::codec {
namespace {

TEST(ItemStacks, TakeLastWhatWasPutFirst)
{
    ItemStacks stacks(1, 4);
    EXPECT_EQ(stacks.top(0), ItemStacks::kNone);
    for (const std::uint32_t item : {2U, 0U, 3U})
    {
        stacks.push(0, item, 0);
    }
    for (const std::uint32_t item : {3U, 0U, 2U})
    {
        EXPECT_EQ(stacks.top(0), item);
        stacks.remove(0, item);
    }
    EXPECT_EQ(stacks.top(0), ItemStacks::kNone);
}

TEST(ItemStacks, MoveWhatIsPutElsewhere)
{
    ItemStacks stacks(2, 4);
    for (const std::uint32_t item : {0U, 1U, 2U})
    {
        stacks.push(0, item, 0);
    }
    stacks.push(1, 1, 0);  // from the middle
    EXPECT_EQ(stacks.top(1), 1U);
    stacks.push(0, 0, 0);  // from the bottom to the top
    EXPECT_EQ(stacks.top(0), 0U);
    stacks.remove(0, 0);
    EXPECT_EQ(stacks.top(0), 2U);
    stacks.push(1, 2, 0);  // from the top
    EXPECT_EQ(stacks.top(0), ItemStacks::kNone);
    EXPECT_EQ(stacks.top(1), 2U);
}

TEST(ItemStacks, KnowWhatLiesOnNone)
{
    ItemStacks stacks(1, 2);
    stacks.push(0, 0, 0);
    stacks.remove(0, 1);
    stacks.remove(0, 0);
    stacks.remove(0, 0);
    EXPECT_EQ(stacks.top(0), ItemStacks::kNone);
}

}  // namespace
}  // namespace vsplit::codec
