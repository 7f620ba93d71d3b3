#include "connection.h"

#include "scripted_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace vsplit::client {
namespace {

using std::chrono::milliseconds;
using Bytes = std::vector<std::byte>;

Bytes file_of(std::size_t count)
{
    Bytes bytes(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        bytes[i] = static_cast<std::byte>(i * 2654435761U >> 13);
    }
    return bytes;
}

ConnectionOptions options_for(const ScriptedServer& server)
{
    ConnectionOptions options;
    options.address = {"127.0.0.1", server.port(), "cow"};
    options.request.screen_width = 240;
    return options;
}

Bytes read_all(Connection& connection)
{
    Bytes received;
    Bytes block(10000);
    while (!connection.bytes().drained())
    {
        connection.bytes().wait(milliseconds(50));
        const std::size_t count = connection.bytes().pop(block);
        received.insert(received.end(), block.begin(), block.begin() + count);
    }
    return received;
}

// Answers an Open as a server does, from the byte that it asks for.
void serve(Peer& peer, const Bytes& file)
{
    const auto open = peer.receive_open();
    ASSERT_TRUE(open.has_value());
    peer.send_info(*open, file.size(), file.size());
    peer.send_data(std::span(file).subspan(open->start));
    peer.send(wire::encode(wire::Done{}));
    peer.receive();
}

TEST(Connection, FetchesAStreamAndCountsItsBytes)
{
    const Bytes file = file_of(300000);
    ScriptedServer server({[&](Peer& peer) { serve(peer, file); }});
    Connection connection(options_for(server));
    EXPECT_EQ(read_all(connection), file);
    EXPECT_FALSE(connection.error().has_value());
    const TransferCounters counters = connection.counters();
    EXPECT_EQ(counters.payload_bytes, file.size());
    EXPECT_EQ(counters.reconnects, 0U);
    // 44 bytes of ModelInfo, 12 or 16 of Done, 4 for each of 19 Data frames.
    EXPECT_GT(counters.wire_bytes, file.size() + 19 * 4);
    EXPECT_LE(counters.wire_bytes, file.size() + 19 * 4 + 64);
}

TEST(Connection, GoesOnAtTheExactByteAfterEveryCut)
{
    const Bytes file = file_of(5000);
    for (const std::size_t cut : {0U, 1U, 999U, 1000U, 1001U, 4999U, 5000U})
    {
        SCOPED_TRACE(cut);
        std::atomic<std::uint64_t> second_start = 0;
        std::atomic<std::uint64_t> second_id = 0;
        ScriptedServer server(
            {[&](Peer& peer) {
                 const auto open = peer.receive_open();
                 ASSERT_TRUE(open.has_value());
                 peer.send_info(*open, file.size(), file.size());
                 peer.send_data(std::span(file).first(cut / 2));
                 // Announces a whole frame and sends the part before the cut.
                 const std::size_t announced = file.size() - cut / 2;
                 peer.send(wire::frame_header(wire::FrameType::Data, announced));
                 peer.send(std::span(file).subspan(cut / 2, cut - cut / 2));
             },
             [&](Peer& peer) {
                 const auto open = peer.receive_open();
                 ASSERT_TRUE(open.has_value());
                 second_start = open->start;
                 second_id = open->content_id;
                 peer.send_info(*open, file.size(), file.size());
                 peer.send_data(std::span(file).subspan(open->start), 700);
                 peer.send(wire::encode(wire::Done{}));
                 peer.receive();
             }}
        );
        Connection connection(options_for(server));
        EXPECT_EQ(read_all(connection), file);
        EXPECT_FALSE(connection.error().has_value());
        EXPECT_EQ(second_start, cut);
        EXPECT_EQ(second_id, 0x1234U);
        EXPECT_EQ(connection.counters().payload_bytes, file.size());
        EXPECT_EQ(connection.counters().reconnects, 1U);
    }
}

TEST(Connection, GivesUpWhenTheContentChanged)
{
    const Bytes file = file_of(1000);
    ScriptedServer server(
        {[&](Peer& peer) {
             const auto open = peer.receive_open();
             ASSERT_TRUE(open.has_value());
             peer.send_info(*open, file.size(), file.size());
             peer.send_data(std::span(file).first(400));
         },
         [&](Peer& peer) {
             peer.content_id = 0x4321;
             serve(peer, file);
         }}
    );
    Connection connection(options_for(server));
    EXPECT_EQ(read_all(connection), Bytes(file.begin(), file.begin() + 400));
    ASSERT_TRUE(connection.error().has_value());
    EXPECT_EQ(connection.error()->code, ErrorCode::ContentChanged);
}

TEST(Connection, EndsWithAnErrorOnGarbageAndDoesNotComeBack)
{
    std::atomic<int> connections = 0;
    const auto garbage = [&](Peer& peer) {
        ++connections;
        peer.receive_open();
        peer.send(Bytes(5000, std::byte{0xEE}));
    };
    ScriptedServer server({garbage, garbage});
    Connection connection(options_for(server));
    EXPECT_TRUE(read_all(connection).empty());
    ASSERT_TRUE(connection.error().has_value());
    EXPECT_EQ(connection.error()->code, ErrorCode::BadFrame);
    EXPECT_EQ(connections, 1);
}

TEST(Connection, ReportsWhatTheServerRefuses)
{
    ScriptedServer server({[&](Peer& peer) {
        peer.receive_open();
        peer.send(wire::encode(wire::Failure{
            static_cast<std::uint16_t>(ErrorCode::NotFound), "no model cow", false}));
        peer.receive();
    }});
    Connection connection(options_for(server));
    EXPECT_TRUE(read_all(connection).empty());
    ASSERT_TRUE(connection.error().has_value());
    EXPECT_EQ(connection.error()->code, ErrorCode::NotFound);
}

TEST(Connection, GivesUpAfterTheAllowedNumberOfAttempts)
{
    std::atomic<int> connections = 0;
    const auto hang_up = [&](Peer& peer) {
        ++connections;
        peer.receive_open();
    };
    ScriptedServer server({hang_up, hang_up, hang_up, hang_up, hang_up});
    ConnectionOptions options = options_for(server);
    options.retries = 2;
    Connection connection(options);
    EXPECT_TRUE(read_all(connection).empty());
    ASSERT_TRUE(connection.error().has_value());
    EXPECT_EQ(connection.error()->code, ErrorCode::ConnectionLost);
    EXPECT_EQ(connections, 3);
    EXPECT_EQ(connection.counters().reconnects, 2U);
}

TEST(Connection, FailsAtOnceWhenNobodyListens)
{
    std::uint16_t port = 0;
    {
        const ScriptedServer server({});
        port = server.port();
    }
    ConnectionOptions options;
    options.address = {"127.0.0.1", port, "cow"};
    Connection connection(options);
    EXPECT_TRUE(read_all(connection).empty());
    ASSERT_TRUE(connection.error().has_value());
    EXPECT_EQ(connection.error()->code, ErrorCode::ConnectionLost);
    EXPECT_EQ(connection.counters().reconnects, 0U);
}

TEST(Connection, DoesNotWaitForEverForASilentServer)
{
    ScriptedServer server({[&](Peer& peer) {
        peer.receive_open();
        peer.receive();  // until the client hangs up
    }});
    ConnectionOptions options = options_for(server);
    options.timeout = milliseconds(50);
    options.retries = 0;
    Connection connection(options);
    EXPECT_TRUE(read_all(connection).empty());
    ASSERT_TRUE(connection.error().has_value());
    EXPECT_EQ(connection.error()->code, ErrorCode::Timeout);
}

TEST(Connection, StopsReadingWhenNobodyTakesTheBytes)
{
    const Bytes file = file_of(4000000);
    ScriptedServer server({[&](Peer& peer) { serve(peer, file); }});
    ConnectionOptions options = options_for(server);
    options.queue_bytes = 10000;
    Connection connection(options);
    while (connection.bytes().space() > 0)
    {
        std::this_thread::sleep_for(milliseconds(1));
    }
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(connection.counters().payload_bytes, 10000U);
    EXPECT_LT(connection.counters().wire_bytes, 10200U);
    EXPECT_EQ(read_all(connection), file);
}

TEST(Connection, AsksAgainWithAnEarlierStop)
{
    const Bytes file = file_of(2000);
    ScriptedServer server({[&](Peer& peer) {
        const auto first = peer.receive_open();
        ASSERT_TRUE(first.has_value());
        EXPECT_EQ(first->stop.level, 9U);
        peer.send_info(*first, file.size(), file.size());
        peer.send_data(std::span(file).first(500));
        const auto cancel = peer.receive();
        ASSERT_TRUE(cancel.has_value());
        EXPECT_EQ(cancel->type, wire::FrameType::Cancel);
        peer.send(wire::encode(wire::Done{wire::DoneReason::Cancelled}));
        const auto second = peer.receive_open();
        ASSERT_TRUE(second.has_value());
        EXPECT_EQ(second->start, 500U);
        EXPECT_EQ(second->stop.level, 4U);
        peer.send_info(*second, file.size(), 800);
        peer.send_data(std::span(file).subspan(500, 300));
        peer.send(wire::encode(wire::Done{}));
        peer.receive();
    }});
    ConnectionOptions options = options_for(server);
    options.stop.condition.level = 9;
    Connection connection(options);
    while (connection.counters().payload_bytes < 500)
    {
        std::this_thread::sleep_for(milliseconds(1));
    }
    StopPlan stop;
    stop.condition.level = 4;
    connection.restrict_to(stop);
    EXPECT_EQ(read_all(connection), Bytes(file.begin(), file.begin() + 800));
    EXPECT_FALSE(connection.error().has_value());
    EXPECT_EQ(connection.counters().reconnects, 0U);
}

TEST(Connection, CarriesTheSameBytesOverASlowLink)
{
    const Bytes file = file_of(20000);
    ScriptedServer server({[&](Peer& peer) { serve(peer, file); }});
    ConnectionOptions options = options_for(server);
    options.link = *parse_link("1600:10");
    Connection connection(options);
    EXPECT_EQ(read_all(connection), file);
    EXPECT_FALSE(connection.error().has_value());
}

TEST(Connection, CanBeDestroyedAtAnyTime)
{
    const Bytes file = file_of(4000000);
    for (const int delay : {0, 1, 20})
    {
        ScriptedServer server({[&](Peer& peer) {
            peer.receive_open();
            peer.send(wire::make_frame(wire::FrameType::Waiting));
            peer.receive();
        }});
        const Connection connection(options_for(server));
        std::this_thread::sleep_for(milliseconds(delay));
    }
}

}  // namespace
}  // namespace vsplit::client
