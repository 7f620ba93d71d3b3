#include "link_profile.h"
#include "link_shaper.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <string>

namespace vsplit::client {
namespace {

using std::chrono::milliseconds;

constexpr LinkShaper::TimePoint kStart{std::chrono::hours(1)};

// Reads as the connection does: whenever the shaper says so, all that it allows.
std::size_t drain_until(LinkShaper& shaper, LinkShaper::TimePoint from, LinkShaper::TimePoint end)
{
    std::size_t total = 0;
    for (auto now = shaper.next_read(from); now < end; now = shaper.next_read(now))
    {
        const std::size_t bytes = shaper.readable(now);
        EXPECT_GT(bytes, 0U);
        shaper.consume(bytes);
        total += bytes;
    }
    return total;
}

TEST(LinkProfile, KnowsItsNames)
{
    EXPECT_FALSE(parse_link("none")->shaped());
    const auto modem = parse_link("modem28");
    ASSERT_TRUE(modem.has_value());
    EXPECT_DOUBLE_EQ(modem->bytes_per_second, 3600.0);
    EXPECT_EQ(parse_link("gprs")->latency, milliseconds(600));
    EXPECT_EQ(parse_link("edge")->latency, milliseconds(300));
    EXPECT_DOUBLE_EQ(parse_link("3g")->bytes_per_second, 200000.0);
    EXPECT_DOUBLE_EQ(parse_link("4g")->bytes_per_second, 1.5e6);
    EXPECT_DOUBLE_EQ(parse_link("wifi")->bytes_per_second, 5e6);
}

TEST(LinkProfile, ReadsRateAndLatency)
{
    const auto link = parse_link("256.5:80");
    ASSERT_TRUE(link.has_value());
    EXPECT_DOUBLE_EQ(link->bytes_per_second, 32062.5);
    EXPECT_EQ(link->latency, milliseconds(80));
    EXPECT_EQ(link->name, "256.5:80");
}

TEST(LinkProfile, RefusesEverythingElse)
{
    for (const std::string text :
         {"",
          "5g",
          "100",
          ":",
          "100:",
          ":20",
          "0:20",
          "-5:20",
          "nan:20",
          "inf:20",
          "1e99:20",
          "100:-1",
          "100:60001",
          "100:20ms",
          "100:2.5",
          "100 :20",
          "100:20:3"})
    {
        const auto link = parse_link(text);
        ASSERT_FALSE(link.has_value()) << text;
        EXPECT_EQ(link.error().code, ErrorCode::UnsupportedInput) << text;
    }
}

TEST(LinkProfile, SizesTheReceiveBufferByTheRate)
{
    EXPECT_EQ(receive_buffer_bytes(*parse_link("none")), 0U);
    EXPECT_EQ(receive_buffer_bytes(*parse_link("modem28")), 4096U);
    EXPECT_EQ(receive_buffer_bytes(*parse_link("3g")), 100000U);
    EXPECT_EQ(receive_buffer_bytes(*parse_link("wifi")), 262144U);
}

TEST(LinkShaper, LetsEverythingThroughWithoutARate)
{
    LinkShaper shaper(LinkProfile{}, kStart);
    EXPECT_EQ(shaper.next_read(kStart), kStart);
    EXPECT_EQ(shaper.readable(kStart), std::numeric_limits<std::size_t>::max());
}

TEST(LinkShaper, DeliversTheRateAndNoMore)
{
    LinkShaper shaper(*parse_link("28.8:0"), kStart);
    const std::size_t bytes = drain_until(shaper, kStart, kStart + std::chrono::seconds(60));
    EXPECT_LE(bytes, 60U * 3600U);
    EXPECT_GE(bytes, 60U * 3600U - 100U);
}

TEST(LinkShaper, DeliversTheRateOfAFastLink)
{
    LinkShaper shaper(*parse_link("wifi"), kStart);
    const std::size_t bytes = drain_until(shaper, kStart, kStart + std::chrono::seconds(3));
    EXPECT_LE(bytes, 15000000U);
    EXPECT_GE(bytes, 14900000U);
}

TEST(LinkShaper, DeliversSlowerThanAByteAQuantum)
{
    LinkShaper shaper(*parse_link("0.1:0"), kStart);
    const std::size_t bytes = drain_until(shaper, kStart, kStart + std::chrono::seconds(10));
    EXPECT_LE(bytes, 125U);
    EXPECT_GE(bytes, 123U);
}

TEST(LinkShaper, HoldsTheAnswerForOneRoundTrip)
{
    LinkShaper shaper(*parse_link("gprs"), kStart);
    const auto asked = kStart + milliseconds(50);
    shaper.hold_for_round_trip(asked);
    EXPECT_EQ(shaper.readable(asked + milliseconds(599)), 0U);
    EXPECT_GE(shaper.next_read(asked), asked + milliseconds(600));
    // Nothing came down the link during the hold: only what the rate gives after it.
    EXPECT_EQ(shaper.readable(asked + milliseconds(610)), 50U);
}

TEST(LinkShaper, TurnsAPauseIntoASmallBurstOnly)
{
    LinkShaper shaper(*parse_link("28.8:0"), kStart);
    EXPECT_EQ(shaper.readable(kStart + std::chrono::minutes(10)), 360U);
}

TEST(LinkShaper, NeverGivesTheSameBytesTwice)
{
    LinkShaper shaper(*parse_link("80:0"), kStart);
    const auto now = kStart + milliseconds(20);
    EXPECT_EQ(shaper.readable(now), 200U);
    shaper.consume(150);
    EXPECT_EQ(shaper.readable(now), 50U);
    shaper.consume(50);
    EXPECT_EQ(shaper.readable(now), 0U);
    EXPECT_EQ(shaper.next_read(now), now + milliseconds(10));
}

}  // namespace
}  // namespace vsplit::client
