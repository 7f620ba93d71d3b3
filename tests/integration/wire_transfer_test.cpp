// What goes over the wire, seen by a client that counts every byte.
#include "integration/model_folder.h"
#include "integration/raw_client.h"
#include "integration/server_process.h"

#include <algorithm>
#include <csignal>
#include <thread>

namespace vsplit::test {
namespace {

using WireTransfer = ModelFolderTest;

std::vector<std::byte> prefix(const EncodedModel& model, std::uint64_t bytes)
{
    return {model.bytes.begin(), model.bytes.begin() + static_cast<std::ptrdiff_t>(bytes)};
}

TEST_F(WireTransfer, SendsExactlyTheBytesThatTheIndexPromisesForEveryLevel)
{
    const auto model = encode("beast.ply", "beast");
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    for (const auto& level : model.info.levels)
    {
        const auto transfer = client.transfer({.model = "beast", .stop = {.level = level.level}});
        ASSERT_EQ(transfer.done, wire::DoneReason::EndReached) << "level " << level.level;
        ASSERT_EQ(transfer.payload, prefix(model, level.cumulative_bytes))
            << "level " << level.level;
        ASSERT_EQ(transfer.info->end, level.cumulative_bytes);
        const double allowed = 1.01 * static_cast<double>(level.cumulative_bytes) + 64.0;
        ASSERT_LE(static_cast<double>(transfer.wire_bytes), allowed) << "level " << level.level;
    }
}

TEST_F(WireTransfer, ResumesAtEveryChunkBoundaryAndInsideEveryChunk)
{
    const auto model = encode("bone.ply", "bone");
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    const auto whole = client.transfer({.model = "bone"});
    ASSERT_EQ(whole.payload, model.bytes);
    for (const auto& chunk : model.info.chunks)
    {
        for (const std::uint64_t start : {chunk.offset, chunk.offset + chunk.bytes / 2})
        {
            const auto rest = client.transfer(
                {.model = "bone", .start = start, .content_id = whole.info->content_id}
            );
            auto joined = prefix(model, start);
            joined.insert(joined.end(), rest.payload.begin(), rest.payload.end());
            ASSERT_EQ(joined, model.bytes) << "from byte " << start;
        }
    }
}

TEST_F(WireTransfer, RefusesToResumeContentThatHasChanged)
{
    static_cast<void>(encode("bone.ply", "model"));
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    const auto first = client.transfer({.model = "model"});
    ASSERT_TRUE(first.info.has_value());
    const auto replaced = encode("terrain.ply", "model");
    const auto rest =
        client.transfer({.model = "model", .start = 100, .content_id = first.info->content_id});
    ASSERT_TRUE(rest.failure.has_value());
    EXPECT_TRUE(rest.payload.empty());
    EXPECT_EQ(client.transfer({.model = "model"}).payload, replaced.bytes);
}

TEST_F(WireTransfer, ObeysEveryStopCondition)
{
    const auto model = encode("beast.ply", "beast");
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    const auto& middle = model.info.levels[model.info.levels.size() / 2];
    const auto expected = prefix(model, middle.cumulative_bytes);
    EXPECT_EQ(
        client.transfer({.model = "beast", .stop = {.faces = middle.faces}}).payload, expected
    );
    EXPECT_EQ(
        client.transfer({.model = "beast", .stop = {.error = middle.rms_error}}).payload, expected
    );
    const auto by_bytes =
        client.transfer({.model = "beast", .stop = {.bytes = middle.cumulative_bytes}}).payload;
    EXPECT_EQ(by_bytes, expected);
}

TEST_F(WireTransfer, ServesEightClientsAtOnce)
{
    const auto model = encode("beast.ply", "beast");
    const ServerProcess server(root_, logs_);
    std::vector<Transfer> transfers(8);
    {
        std::vector<std::jthread> threads;
        for (auto& transfer : transfers)
        {
            threads.emplace_back([&transfer, port = server.port()] {
                transfer = RawClient(port).transfer({.model = "beast"});
            });
        }
    }
    for (const auto& transfer : transfers)
    {
        EXPECT_EQ(transfer.done, wire::DoneReason::EndReached);
        EXPECT_EQ(transfer.payload, model.bytes);
    }
}

TEST_F(WireTransfer, PausesResumesAndCancels)
{
    const auto model = encode("beast.ply", "beast");
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    ASSERT_TRUE(client.send(wire::make_frame(wire::FrameType::Pause)));
    ASSERT_TRUE(client.open({.model = "beast"}));
    ASSERT_TRUE(client.send(wire::make_frame(wire::FrameType::Pause)));
    ASSERT_TRUE(client.send(wire::make_frame(wire::FrameType::Resume)));
    EXPECT_EQ(client.finish().payload, model.bytes);

    ASSERT_TRUE(client.open({.model = "beast"}));
    ASSERT_TRUE(client.send(wire::make_frame(wire::FrameType::Cancel)));
    const auto cancelled = client.finish();
    ASSERT_TRUE(cancelled.done.has_value());
    EXPECT_TRUE(std::equal(cancelled.payload.begin(), cancelled.payload.end(), model.bytes.begin())
    );
    EXPECT_EQ(client.transfer({.model = "beast"}).payload, model.bytes);
}

}  // namespace
}  // namespace vsplit::test
