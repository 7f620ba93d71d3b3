#include "precompute/order_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using precompute::best_path;
using precompute::ErrorTable;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(BestPath, TakesWhatHelpsFirst)
{
    // Only the second sequence makes pictures better.
    const ErrorTable table{{{{100.0, 200.0}, {0.0, 100.0}}}, {1000.0, 10.0, 1000.0, 10.0}};
    EXPECT_THAT(best_path(table), ElementsAre(1, 0));
}

TEST(BestPath, TakesTheShorterOfTwoThatHelpAlike)
{
    const ErrorTable table{{{{100.0, 1100.0}, {0.0, 50.0}}}, {1000.0, 500.0, 500.0, 100.0}};
    EXPECT_THAT(best_path(table), ElementsAre(1, 0));
}

TEST(BestPath, SeesWhatOnlyPaysTogether)
{
    // The first helps a little at once; both steps of the second help much, the first of
    // them alone not at all.
    const ErrorTable table{
        {{{100.0, 1000.0}, {0.0, 50.0, 100.0}}}, {1000.0, 1000.0, 10.0, 900.0, 900.0, 5.0}};
    EXPECT_THAT(best_path(table), ElementsAre(1, 1, 0));
}

TEST(BestPath, HasNoStepsBetweenSingleStates)
{
    const ErrorTable table{{{{100.0}, {0.0}}}, {1000.0}};
    EXPECT_THAT(best_path(table), IsEmpty());
}

}  // namespace
}  // namespace vsplit::test
