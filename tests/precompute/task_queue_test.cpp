#include "precompute/task_queue.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace vsplit::test {
namespace {

TEST(TaskQueue, RunsTasksInOrder)
{
    precompute::TaskQueue queue;
    std::vector<int> done;
    for (int i = 0; i < 500; ++i)
    {
        queue.run([&done, i] { done.push_back(i); });
    }
    queue.wait();
    std::vector<int> wanted(500);
    std::iota(wanted.begin(), wanted.end(), 0);
    EXPECT_EQ(done, wanted);
    queue.run([&done] { done.clear(); });
    queue.wait();
    EXPECT_TRUE(done.empty());
}

TEST(TaskQueue, WaitsForNothingWhenThereIsNothing)
{
    precompute::TaskQueue queue;
    queue.wait();
}

TEST(TaskQueue, FinishesWhatIsQueuedBeforeItEnds)
{
    int done = 0;
    {
        precompute::TaskQueue queue;
        for (int i = 0; i < 100; ++i)
        {
            queue.run([&done] { ++done; });
        }
    }
    EXPECT_EQ(done, 100);
}

}  // namespace
}  // namespace vsplit::test
