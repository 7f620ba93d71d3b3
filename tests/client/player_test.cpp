#include "player.h"

#include "codec/stream_decoder.h"
#include "core/file_io.h"
#include "encoded_torus.h"
#include "gl_context.h"
#include "scripted_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace vsplit::client {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kFrameBytes = 1000;

// Serves a file as vsplitd does: up to the stop condition, cancelling, as often as the client asks.
void serve(Peer& peer, const TestStream& stream)
{
    while (const auto open = peer.receive_open())
    {
        codec::StopCondition stop;
        stop.level = open->stop.level;
        stop.bytes = open->stop.bytes;
        stop.faces = open->stop.faces;
        const std::uint64_t end = codec::stop_offset(stream.info, stop);
        peer.send_info(*open, stream.file.size(), end);
        if (open->start < end)
        {
            peer.send_data(
                std::span(stream.file).subspan(open->start, end - open->start), kFrameBytes
            );
        }
        peer.send(wire::encode(wire::Done{}));
    }
}

Options options_for(const ScriptedServer& server)
{
    Options options;
    options.address = {"127.0.0.1", server.port(), "torus"};
    options.render = false;
    options.retries = 0;
    return options;
}

std::filesystem::path temporary(const std::string& name)
{
    return std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + "-" + name);
}

TEST(Player, ShowsEveryLevelWithTheBytesThatTheIndexPromises)
{
    const TestStream& stream = encoded_torus();
    ScriptedServer server({[&](Peer& peer) { serve(peer, stream); }});
    const Options options = options_for(server);
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    const Report& report = player.report();
    ASSERT_EQ(report.levels.size(), stream.info.levels.size());
    for (std::size_t i = 0; i < report.levels.size(); ++i)
    {
        const LevelRow& row = report.levels[i];
        const codec::LevelInfo& level = stream.info.levels[i];
        EXPECT_EQ(row.level, level.level);
        EXPECT_EQ(row.vertices, level.vertices);
        EXPECT_EQ(row.faces, level.faces);
        EXPECT_EQ(row.bytes.sum(), level.chunk_bytes);
        EXPECT_EQ(row.cumulative_bytes, level.cumulative_bytes);
        EXPECT_TRUE(row.frame_ms.empty());
    }
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.transferred.payload_bytes, stream.file.size());
    const std::size_t data_frames = (stream.file.size() + kFrameBytes - 1) / kFrameBytes;
    const std::size_t framing = wire::encode(wire::ModelInfo{.content_id = 1, .end = 1}).size() +
                                wire::encode(wire::Done{}).size() +
                                data_frames * proto::kFrameHeaderBytes;
    EXPECT_EQ(report.transferred.wire_bytes, stream.file.size() + framing);
    EXPECT_NE(
        out.str().find("complete: the last level has 3456 vertices and 6912 triangles, equal to the"
                       " quantised original"),
        std::string::npos
    );
}

TEST(Player, StopsWhereItIsTold)
{
    const TestStream& stream = encoded_torus();
    ScriptedServer server({[&](Peer& peer) { serve(peer, stream); }});
    Options options = options_for(server);
    options.stop.condition.level = 3;
    std::ostringstream out;
    Player player(options, out);
    ASSERT_TRUE(player.run().has_value());
    EXPECT_EQ(player.report().levels.size(), 4U);
    EXPECT_FALSE(player.report().complete);
    EXPECT_EQ(player.report().transferred.payload_bytes, stream.info.levels[3].cumulative_bytes);
    EXPECT_EQ(out.str().find("complete"), std::string::npos);
    EXPECT_NE(out.str().find("stopped at level 3"), std::string::npos);
}

TEST(Player, StopsAtTheFinestLevelThatFitsTheMemory)
{
    const TestStream& stream = encoded_torus();
    ScriptedServer server({[&](Peer& peer) { serve(peer, stream); }});
    Options options = options_for(server);
    options.device.memory_bytes = 500000;
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    const Report& report = player.report();
    ASSERT_FALSE(report.levels.empty());
    EXPECT_LT(report.levels.size(), stream.info.levels.size());
    EXPECT_LE(report.memory_planned_bytes, 500000U);
    EXPECT_FALSE(report.complete);
    EXPECT_NE(out.str().find("is the finest that fits"), std::string::npos);
}

TEST(Player, RefusesAModelWhoseBaseDoesNotFit)
{
    ScriptedServer server({[&](Peer& peer) { serve(peer, encoded_torus()); }});
    Options options = options_for(server);
    options.device.memory_bytes = 1 << 16;
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_FALSE(played.has_value());
    EXPECT_EQ(played.error().code, ErrorCode::LimitExceeded);
}

TEST(Player, SavesTheMeshThatTheDecoderGives)
{
    const TestStream& stream = encoded_torus();
    ScriptedServer server({[&](Peer& peer) { serve(peer, stream); }});
    Options options = options_for(server);
    options.save = temporary("torus.ply");
    std::ostringstream out;
    Player player(options, out);
    ASSERT_TRUE(player.run().has_value());
    const auto ply = read_file(options.save);
    std::filesystem::remove(options.save);
    ASSERT_TRUE(ply.has_value());

    codec::StreamDecoder decoder;
    std::span<const std::byte> bytes = stream.file;
    while (!decoder.complete())
    {
        bytes = bytes.subspan(*decoder.feed(bytes));
        ASSERT_TRUE(decoder.step().has_value());
    }
    const IndexedMesh mesh = codec::extract_mesh(decoder);
    const std::string text(reinterpret_cast<const char*>(ply->data()), ply->size());
    const std::size_t header_end = text.find("end_header\n") + 11;
    EXPECT_NE(text.find("element vertex 3456\n"), std::string::npos);
    EXPECT_NE(text.find("element face 6912\n"), std::string::npos);
    const std::size_t vertex_bytes = mesh.positions.size() * 3 * sizeof(double);
    ASSERT_EQ(ply->size(), header_end + vertex_bytes + mesh.triangles.size() * 13);
    EXPECT_EQ(std::memcmp(ply->data() + header_end, mesh.positions.data(), vertex_bytes), 0);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        const std::byte* face = ply->data() + header_end + vertex_bytes + 13 * i;
        ASSERT_EQ(face[0], std::byte{3});
        ASSERT_EQ(std::memcmp(face + 1, mesh.triangles[i].data(), 12), 0);
    }
}

TEST(Player, DrawsTheFramesThatAreAskedForAndWritesAPicturePerLevel)
{
    if (const auto context = GlContext::create(); !context)
    {
        GTEST_SKIP() << describe(context.error());
    }
    const TestStream& stream = encoded_torus();
    ScriptedServer server({[&](Peer& peer) { serve(peer, stream); }});
    Options options = options_for(server);
    options.render = true;
    options.frames = 3;
    options.screenshots = temporary("pictures");
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_TRUE(played.has_value()) << describe(played.error());
    for (const LevelRow& row : player.report().levels)
    {
        EXPECT_GE(row.frame_ms.size(), 3U);
    }
    std::size_t pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(options.screenshots))
    {
        EXPECT_EQ(entry.path().extension(), ".png");
        ++pictures;
    }
    EXPECT_EQ(pictures, stream.info.levels.size());
    EXPECT_TRUE(std::filesystem::exists(options.screenshots / "level-000.png"));
    std::filesystem::remove_all(options.screenshots);
}

TEST(Player, KeepsWhatItShowedWhenTheStreamIsDamaged)
{
    TestStream stream = encoded_torus();
    stream.file[stream.info.levels[5].cumulative_bytes - 3] ^= std::byte{1};
    ScriptedServer server({[&](Peer& peer) { serve(peer, stream); }});
    const Options options = options_for(server);
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_FALSE(played.has_value());
    EXPECT_EQ(played.error().code, ErrorCode::BadChecksum);
    EXPECT_EQ(player.report().levels.size(), 5U);
    EXPECT_FALSE(player.report().complete);
}

TEST(Player, SaysWhatIsWrongWithAStreamThatIsNone)
{
    const Bytes noise(5000, std::byte{0x41});
    ScriptedServer server({[&](Peer& peer) {
        const auto open = peer.receive_open();
        ASSERT_TRUE(open.has_value());
        peer.send_info(*open, noise.size(), noise.size());
        peer.send_data(noise);
        peer.send(wire::encode(wire::Done{}));
        peer.receive();
    }});
    const Options options = options_for(server);
    std::ostringstream out;
    Player player(options, out);
    const auto played = player.run();
    ASSERT_FALSE(played.has_value());
    EXPECT_EQ(played.error().code, ErrorCode::BadMagic);
}

TEST(Player, NoticesAServerThatEndsEarly)
{
    const TestStream& stream = encoded_torus();
    for (const std::uint64_t end :
         {std::uint64_t{0},
          std::uint64_t{10},
          std::uint64_t{stream.info.header_bytes} - 1,
          std::uint64_t{stream.info.header_bytes},
          stream.info.levels[2].cumulative_bytes,
          stream.info.levels[2].cumulative_bytes + 7})
    {
        SCOPED_TRACE(end);
        ScriptedServer server({[&](Peer& peer) {
            const auto open = peer.receive_open();
            ASSERT_TRUE(open.has_value());
            peer.send_info(*open, stream.file.size(), end);
            peer.send_data(std::span(stream.file).first(end));
            peer.send(wire::encode(wire::Done{}));
            peer.receive();
        }});
        const Options options = options_for(server);
        std::ostringstream out;
        Player player(options, out);
        const auto played = player.run();
        ASSERT_FALSE(played.has_value());
        EXPECT_EQ(played.error().code, ErrorCode::Truncated);
    }
}

}  // namespace
}  // namespace vsplit::client
