#include "codec/initial_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace vsplit::test {
namespace {

using codec::initial_model;
using codec::LearnedModel;
using codec::pack_model;

// Not std::array: clang counts at most 256 arguments to deduce its size from.
constexpr int kTable[]{
#include "initial_model.inc"
};

TEST(InitialModel, PacksIntoTheTableThatItComesFrom)
{
    const std::vector<LearnedModel> models{initial_model()};
    const auto packed = pack_model(models);
    ASSERT_EQ(packed.size(), std::size(kTable));
    for (std::size_t i = 0; i < packed.size(); ++i)
    {
        ASSERT_EQ(packed[i], kTable[i]) << "entry " << i;
    }
}

TEST(InitialModel, IsTheMeanOfWhatItIsLearnedFrom)
{
    const std::vector<LearnedModel> one{initial_model()};
    const std::vector<LearnedModel> three{initial_model(), initial_model(), initial_model()};
    EXPECT_EQ(pack_model(three), pack_model(one));

    std::vector<LearnedModel> two(2);
    two[0].connectivity.boundary[0] = 20 * 2048;
    two[1].connectivity.boundary[0] = -10 * 2048;
    two[0].geometry.normal[0].nonzero = {1000, 30};
    EXPECT_EQ(pack_model(two), pack_model(std::vector{two[1], two[0]}));
    const auto packed = pack_model(two);
    // One weight and one probability are set; the latter only one mesh has seen.
    EXPECT_EQ(std::ranges::count_if(packed, [](std::uint8_t entry) { return entry != 0; }), 2);
    EXPECT_THAT(packed, ::testing::Contains(5));
    EXPECT_THAT(packed, ::testing::Contains(1000 / 256));
}

TEST(InitialModel, KeepsToTheRangeOfItsEntries)
{
    std::vector<LearnedModel> models(1);
    models[0].connectivity.boundary = {1 << 30, -(1 << 30)};
    models[0].geometry.normal[0].nonzero = {0, 120};
    models[0].geometry.normal[0].sign[0] = {65535, 120};
    const auto packed = pack_model(models);
    EXPECT_THAT(packed, ::testing::IsSupersetOf({127, 256 - 127, 1, 255}));
}

}  // namespace
}  // namespace vsplit::test
