#include "gl_context.h"
#include "gl_textures.h"
#include "image/texture_layout.h"
#include "painted_torus.h"
#include "player.h"
#include "scripted_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <unistd.h>

namespace vsplit::client {
namespace {

constexpr std::size_t kFrameBytes = 1000;

// Answers an Open as vsplitd does, without looking at a Cancel that crosses the Done.
void answer(Peer& peer, const wire::Open& open, const TestStream& stream)
{
    codec::StopCondition stop;
    stop.level = open.stop.level;
    stop.bytes = open.stop.bytes;
    const std::uint64_t end = codec::stop_offset(stream.info, stop);
    peer.send_info(open, stream.file.size(), end);
    if (open.start < end)
    {
        peer.send_data(std::span(stream.file).subspan(open.start, end - open.start), kFrameBytes);
    }
    peer.send(wire::encode(wire::Done{}));
}

void answer_all(Peer& peer, const TestStream& stream)
{
    while (const auto frame = peer.receive())
    {
        if (frame->type == wire::FrameType::Open)
        {
            answer(peer, wire::parse_open(frame->payload).value(), stream);
        }
    }
}

// Sends the first `bytes` and then waits to be told what is not wanted, as on a slow link.
void answer_slowly(Peer& peer, const TestStream& stream, std::uint64_t bytes)
{
    const auto open = peer.receive_open();
    ASSERT_TRUE(open.has_value());
    peer.send_info(*open, stream.file.size(), stream.file.size());
    peer.send_data(std::span(stream.file).first(bytes), kFrameBytes);
    const auto cancel = peer.receive();
    ASSERT_TRUE(cancel.has_value());
    ASSERT_EQ(cancel->type, wire::FrameType::Cancel);
    peer.send(wire::encode(wire::Done{wire::DoneReason::Cancelled}));
    answer_all(peer, stream);
}

Options options_for(const ScriptedServer& server)
{
    Options options;
    options.address = {"127.0.0.1", server.port(), "torus"};
    options.render = false;
    options.retries = 0;
    options.device.memory_bytes = 64U << 20;
    return options;
}

ChunkBytes sum_of(const Report& report)
{
    ChunkBytes sum;
    for (const LevelRow& row : report.levels)
    {
        sum += row.bytes;
    }
    return sum;
}

TEST(PaintedPlayer, LeavesOutEverythingButTheShapeWhenToldTo)
{
    const PaintedStream& painted = painted_torus();
    const TestStream& stream = painted.stream;
    ScriptedServer server({[&](Peer& peer) {
        answer_slowly(peer, stream, stream.info.header_bytes);
    }});
    Options options = options_for(server);
    options.attributes = false;
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    const Report& report = player.report();
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.levels.size(), stream.info.levels.size());
    const std::uint64_t optional =
        painted.appearance_bytes + painted.drawn_bytes + painted.idle_bytes;
    const std::uint64_t shape = stream.file.size() - optional;
    // Materials and the small image are a gap that is too short to pay.
    const std::uint64_t taken = painted.appearance_bytes + painted.drawn_bytes;
    EXPECT_EQ(report.transferred.payload_bytes, shape + taken);
    EXPECT_EQ(sum_of(report), (ChunkBytes{shape - stream.info.header_bytes, 0, taken}));
    EXPECT_FALSE(report.surface);
}

TEST(PaintedPlayer, TakesWhatIsUnwantedButAlreadyOnItsWay)
{
    const TestStream& stream = painted_torus().stream;
    ScriptedServer server({[&](Peer& peer) { answer_all(peer, stream); }});
    Options options = options_for(server);
    options.attributes = false;
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    EXPECT_TRUE(player.report().complete);
    EXPECT_EQ(player.report().levels.size(), stream.info.levels.size());
}

TEST(PaintedPlayer, LeavesOutAnyChunkWhereverTheTransferStands)
{
    const TestStream& stream = painted_torus().stream;
    for (std::uint64_t bytes = stream.info.header_bytes; bytes < stream.file.size();
         bytes += stream.file.size() / 23)
    {
        SCOPED_TRACE(bytes);
        ScriptedServer server({[&](Peer& peer) { answer_slowly(peer, stream, bytes); }});
        Options options = options_for(server);
        options.attributes = false;
        std::ostringstream out;
        Player player(options, out);
        const auto played = player.run();
        ASSERT_TRUE(played.has_value()) << describe(played.error());
        EXPECT_TRUE(player.report().complete);
        EXPECT_GE(player.report().transferred.payload_bytes, bytes);
    }
}

class PaintedDisplay : public testing::Test
{
protected:
    void SetUp() override
    {
        if (const auto context = GlContext::create(); !context)
        {
            GTEST_SKIP() << describe(context.error());
        }
    }
};

TEST_F(PaintedDisplay, DecodesAndCountsTexturesAsTheySharpen)
{
    const PaintedStream& painted = painted_torus();
    const TestStream& stream = painted.stream;
    ScriptedServer server({[&](Peer& peer) { answer_all(peer, stream); }});
    Options options = options_for(server);
    options.render = true;
    options.frames = 2;
    options.device.texture_limit = 256;
    if (const char* folder = std::getenv("VSPLIT_PICTURES"))
    {
        options.screenshots = folder;  // For looking at.
    }
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    const Report& report = player.report();
    EXPECT_TRUE(report.complete);
    EXPECT_TRUE(report.surface);
    EXPECT_EQ(report.texture_limit, 256U);
    const ChunkBytes sum = sum_of(report);
    EXPECT_GE(sum.textures, painted.appearance_bytes + painted.drawn_bytes);
    EXPECT_EQ(sum.attributes, 0U);  // tests/integration/painted_test.cpp has real ones
    std::size_t images = 0;
    for (const LevelRow& row : report.levels)
    {
        images += row.images;
        EXPECT_LE(row.images, row.frame_ms.size()) << "one image a frame";
    }
    EXPECT_GE(images, 1U);
    const LevelRow& last = report.levels.back();
    EXPECT_GE(last.texture_memory_bytes, texture_bytes(256, 256));
    EXPECT_LE(last.texture_memory_bytes, texture_bytes(256, 256) + painted.drawn_bytes);
    EXPECT_NE(out.str().find("attribs"), std::string::npos);
}

TEST_F(PaintedDisplay, LeavesOutImagesThatNothingDraws)
{
    const PaintedStream& painted = painted_torus();
    const TestStream& stream = painted.stream;
    const auto idle = std::ranges::find_if(stream.info.chunks, [](const auto& chunk) {
        return chunk.kind == proto::ChunkKind::Texture &&
               image::parse_texture_tag(chunk.tag).image == 1;
    });
    if (idle == stream.info.chunks.end())
    {
        GTEST_SKIP() << "the index has no tags";
    }
    // The materials have come, the image that nothing draws is still on its way.
    ScriptedServer server({[&](Peer& peer) { answer_slowly(peer, stream, idle->offset); }});
    Options options = options_for(server);
    options.render = true;
    options.frames = 2;
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    const Report& report = player.report();
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.transferred.payload_bytes, stream.file.size() - painted.idle_bytes);
    EXPECT_EQ(sum_of(report).textures, painted.appearance_bytes + painted.drawn_bytes);
    EXPECT_LE(report.levels.back().texture_memory_bytes, report.texture_planned_bytes);
}

}  // namespace
}  // namespace vsplit::client
