#include "byte_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>
#include <vector>

namespace vsplit::client {
namespace {

using std::chrono::milliseconds;

std::vector<std::byte> counting_bytes(std::size_t count, std::size_t first = 0)
{
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        bytes[i] = static_cast<std::byte>((first + i) * 131 >> 3);
    }
    return bytes;
}

TEST(ByteQueue, KeepsTheOrderAcrossTheEndOfTheRing)
{
    ByteQueue queue(7);
    std::mt19937 random(11);
    std::size_t pushed = 0;
    std::size_t popped = 0;
    while (popped < 1000)
    {
        const std::size_t count =
            std::uniform_int_distribution<std::size_t>(0, queue.space())(random);
        queue.push(counting_bytes(count, pushed));
        pushed += count;
        std::vector<std::byte> out(std::uniform_int_distribution<std::size_t>(0, 9)(random));
        out.resize(queue.pop(out));
        ASSERT_EQ(out, counting_bytes(out.size(), popped));
        popped += out.size();
        ASSERT_EQ(queue.space(), 7 - (pushed - popped));
    }
}

TEST(ByteQueue, TellsTheWriterAboutRoom)
{
    int calls = 0;
    ByteQueue queue(4, [&] { ++calls; });
    std::vector<std::byte> out(2);
    EXPECT_EQ(queue.pop(out), 0U);
    EXPECT_EQ(calls, 0);
    queue.push(counting_bytes(4));
    EXPECT_EQ(queue.space(), 0U);
    EXPECT_EQ(queue.pop(out), 2U);
    EXPECT_EQ(calls, 1);
}

TEST(ByteQueue, EndsTheWaitWhenClosedAndIsDrainedAfterTheLastByte)
{
    ByteQueue queue(4);
    EXPECT_FALSE(queue.wait(milliseconds(1)));
    queue.push(counting_bytes(1));
    std::thread writer([&] { queue.close(); });
    EXPECT_TRUE(queue.wait(std::chrono::hours(1)));
    writer.join();
    EXPECT_FALSE(queue.drained());
    std::vector<std::byte> out(4);
    EXPECT_EQ(queue.pop(out), 1U);
    EXPECT_TRUE(queue.drained());
    EXPECT_FALSE(queue.wait(std::chrono::hours(1)));
}

TEST(ByteQueue, CarriesBytesBetweenTwoThreads)
{
    constexpr std::size_t kBytes = 200000;
    const auto sent = counting_bytes(kBytes);
    ByteQueue queue(777);
    std::thread writer([&] {
        std::size_t done = 0;
        while (done < kBytes)
        {
            const std::size_t count = std::min(queue.space(), kBytes - done);
            queue.push(std::span(sent).subspan(done, count));
            done += count;
        }
        queue.close();
    });
    std::vector<std::byte> received;
    std::vector<std::byte> block(1000);
    while (!queue.drained())
    {
        queue.wait(milliseconds(100));
        const std::size_t count = queue.pop(block);
        received.insert(received.end(), block.begin(), block.begin() + count);
    }
    writer.join();
    EXPECT_EQ(received, sent);
}

}  // namespace
}  // namespace vsplit::client
