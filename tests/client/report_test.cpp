#include "report.h"

#include "retry_policy.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace vsplit::client {
namespace {

using std::chrono::milliseconds;

TEST(Percentile, OfNothingIsZero)
{
    EXPECT_DOUBLE_EQ(percentile({}, 0.5), 0.0);
    const FrameTimes times = summarize({});
    EXPECT_DOUBLE_EQ(times.median_ms, 0.0);
    EXPECT_DOUBLE_EQ(times.fps, 0.0);
}

TEST(Percentile, InterpolatesBetweenNeighboursOfUnsortedSamples)
{
    const std::vector<double> samples{4.0, 1.0, 3.0, 2.0};
    EXPECT_DOUBLE_EQ(percentile(samples, 0.0), 1.0);
    EXPECT_DOUBLE_EQ(percentile(samples, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(percentile(samples, 0.95), 3.85);
    EXPECT_DOUBLE_EQ(percentile(samples, 1.0), 4.0);
    EXPECT_DOUBLE_EQ(percentile(std::vector<double>{7.0}, 0.95), 7.0);
}

TEST(FrameTimes, CountFramesPerSecondOverTheirSum)
{
    const FrameTimes times = summarize(std::vector<double>{10.0, 10.0, 30.0, 30.0});
    EXPECT_DOUBLE_EQ(times.median_ms, 20.0);
    EXPECT_DOUBLE_EQ(times.fps, 50.0);
}

TEST(Report, HasTheNamesThatProgramsRelyOn)
{
    Report report;
    report.model = "scans/cow";
    report.device = "pda";
    report.link = "gprs";
    LevelRow row;
    row.level = 0;
    row.vertices = 40;
    row.faces = 76;
    row.bytes.geometry = 300;
    row.cumulative_bytes = 700;
    row.frame_ms = {10.0, 20.0, 30.0};
    report.levels.push_back(row);
    report.transferred = {700, 780, 2};
    report.complete = true;

    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json.at("model"), "scans/cow");
    EXPECT_EQ(json.at("device"), "pda");
    EXPECT_EQ(json.at("link"), "gprs");
    const auto& level = json.at("levels").at(0);
    EXPECT_EQ(level.at("level"), 0);
    EXPECT_EQ(level.at("vertices"), 40);
    EXPECT_EQ(level.at("faces"), 76);
    EXPECT_EQ(level.at("chunk_bytes"), 300);
    EXPECT_EQ(level.at("cumulative_bytes"), 700);
    EXPECT_EQ(level.at("frames"), 3);
    EXPECT_DOUBLE_EQ(level.at("frame_ms_median"), 20.0);
    EXPECT_DOUBLE_EQ(level.at("frame_ms_p95"), 29.0);
    EXPECT_DOUBLE_EQ(level.at("fps"), 50.0);
    for (const char* name :
         {"seconds",
          "decode_ms",
          "resident_bytes",
          "geometry_bytes",
          "attribute_bytes",
          "texture_bytes",
          "images",
          "image_ms",
          "texture_memory_bytes"})
    {
        EXPECT_TRUE(level.contains(name)) << name;
    }
    const auto& totals = json.at("totals");
    EXPECT_EQ(totals.at("payload_bytes"), 700);
    EXPECT_EQ(totals.at("wire_bytes"), 780);
    EXPECT_EQ(totals.at("reconnects"), 2);
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_TRUE(totals.contains("seconds"));
}

TEST(Report, SplitsBytesByWhatTheyAreAbout)
{
    Report report;
    report.surface = true;
    report.texture_limit = 512;
    report.levels.resize(2);
    report.levels[0].bytes.add(proto::ChunkKind::Base, 100);
    report.levels[0].bytes.add(proto::ChunkKind::Attributes, 20);
    report.levels[1].bytes.add(proto::ChunkKind::Texture, 3);
    report.levels[1].bytes.add(proto::ChunkKind::Stitch, 1000);
    report.levels[1].bytes.add(proto::ChunkKind::Appearance, 4);
    report.levels[1].images = 2;
    report.levels[1].image_ms = 1.5;
    const nlohmann::ordered_json json = to_json(report);
    EXPECT_EQ(json.at("levels").at(0).at("chunk_bytes"), 120);
    EXPECT_EQ(json.at("levels").at(1).at("texture_bytes"), 7);
    EXPECT_EQ(json.at("totals").at("geometry_bytes"), 1100);
    EXPECT_EQ(json.at("totals").at("attribute_bytes"), 20);
    EXPECT_EQ(json.at("totals").at("texture_bytes"), 7);
    EXPECT_EQ(json.at("totals").at("images"), 2);
    EXPECT_EQ(json.at("memory").at("texture_limit"), 512);
    // Columns stand under their heads, with and without those for attributes.
    for (const bool surface : {false, true})
    {
        report.surface = surface;
        const std::string head = table_head(report);
        EXPECT_EQ(table_row(report, report.levels[1]).size(), head.find('\n'));
        EXPECT_EQ(head.find("attribs") != std::string::npos, surface);
    }
}

TEST(Report, ReadsTheResidentMemoryOfThisProcess)
{
    EXPECT_GT(resident_bytes(), 100000U);
}

TEST(RetryPolicy, PausesLongerAndLongerAndGivesUp)
{
    RetryPolicy policy(8);
    const std::vector<int> expected{100, 200, 400, 800, 1600, 3200, 5000, 5000};
    for (const int pause : expected)
    {
        EXPECT_EQ(policy.next_pause(ErrorCode::ConnectionLost, false), milliseconds(pause));
    }
    EXPECT_FALSE(policy.next_pause(ErrorCode::ConnectionLost, false).has_value());
}

TEST(RetryPolicy, StartsAgainAfterProgress)
{
    RetryPolicy policy(2);
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_EQ(policy.next_pause(ErrorCode::ConnectionLost, true), milliseconds(100));
        EXPECT_EQ(policy.next_pause(ErrorCode::Timeout, false), milliseconds(200));
    }
    EXPECT_FALSE(policy.next_pause(ErrorCode::Timeout, false).has_value());
}

TEST(RetryPolicy, DoesNotRepeatWhatCannotHelp)
{
    for (const ErrorCode code :
         {ErrorCode::NotFound,
          ErrorCode::BadFrame,
          ErrorCode::BadRequest,
          ErrorCode::ContentChanged,
          ErrorCode::EncodeFailed})
    {
        EXPECT_FALSE(RetryPolicy(5).next_pause(code, true).has_value()) << error_name(code);
    }
    EXPECT_FALSE(RetryPolicy(0).next_pause(ErrorCode::ConnectionLost, true).has_value());
    EXPECT_TRUE(RetryPolicy(1).next_pause(ErrorCode::Overloaded, false).has_value());
    EXPECT_TRUE(RetryPolicy(1).next_pause(ErrorCode::Cancelled, false).has_value());
}

}  // namespace
}  // namespace vsplit::client
