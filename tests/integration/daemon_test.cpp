// The daemon's life: shutting down, encoding source meshes once.
#include "core/file_io.h"
#include "integration/model_folder.h"
#include "integration/raw_client.h"
#include "integration/server_process.h"

#include <csignal>
#include <fstream>
#include <thread>

namespace vsplit::test {
namespace {

namespace fs = std::filesystem;
using Daemon = ModelFolderTest;
using std::chrono::seconds;

TEST_F(Daemon, ExitsWithZeroOnSigtermWhenIdle)
{
    ServerProcess server(root_, logs_);
    server.process().signal(SIGTERM);
    EXPECT_EQ(server.process().wait(seconds(60)), 0);
}

TEST_F(Daemon, FinishesRunningTransfersOnSigterm)
{
    const auto model = encode_large("large");
    ServerProcess server(root_, logs_);
    RawClient client(server.port(), 4096);
    ASSERT_TRUE(client.open({.model = "large"}));
    const auto info = client.next();
    ASSERT_TRUE(info.has_value());
    server.process().signal(SIGTERM);
    const auto transfer = client.finish();
    EXPECT_EQ(transfer.done, wire::DoneReason::EndReached);
    EXPECT_EQ(transfer.payload, model.bytes);
    EXPECT_EQ(server.process().wait(seconds(60)), 0);
    EXPECT_FALSE(Socket::connect(server.port()).open());
}

TEST_F(Daemon, EncodesASourceMeshOnceForTwoClients)
{
    fs::copy_file(asset("beast.ply"), root_ / "beast.ply");
    const fs::path cache = folder_ / "cache";
    const auto expected = encode("beast.ply", "expected");
    // A wrapper in place of the encoder leaves a line for every call.
    const fs::path calls = folder_ / "calls";
    const fs::path wrapper = folder_ / "encoder";
    std::ofstream(wrapper) << "#!/bin/sh\necho called >> '" << calls.string() << "'\nexec '"
                           << program("vsplit") << "' \"$@\"\n";
    fs::permissions(wrapper, fs::perms::owner_all);
    const ServerProcess server(
        root_,
        logs_,
        {"--cache", cache.string(), "--encoder", wrapper.string(), "--encode-memory", "0"}
    );
    std::vector<Transfer> transfers(2);
    {
        std::vector<std::jthread> threads;
        for (auto& transfer : transfers)
        {
            threads.emplace_back([&transfer, port = server.port()] {
                transfer = RawClient(port).transfer({.model = "beast.ply"});
            });
        }
    }
    EXPECT_EQ(transfers[0].payload, expected.bytes);
    EXPECT_EQ(transfers[1].payload, expected.bytes);
    EXPECT_EQ(RawClient(server.port()).transfer({.model = "beast.ply"}).payload, expected.bytes);
    EXPECT_EQ(fs::file_size(calls), std::string("called\n").size());
}

TEST_F(Daemon, SaysWhyASourceMeshCannotBeEncoded)
{
    ASSERT_TRUE(
        write_file_atomically(root_ / "broken.ply", std::vector<std::byte>(5000)).has_value()
    );
    const fs::path cache = folder_ / "cache";
    const ServerProcess server(root_, logs_, {"--cache", cache.string(), "--encode-memory", "0"});
    RawClient client(server.port());
    const auto answer = client.transfer({.model = "broken.ply"});
    ASSERT_TRUE(answer.failure.has_value());
    EXPECT_EQ(answer.failure->code, static_cast<std::uint16_t>(ErrorCode::EncodeFailed));
    EXPECT_FALSE(answer.failure->message.empty());
}

TEST_F(Daemon, SaysSoWhenItsPortIsTaken)
{
    const ServerProcess first(root_, logs_);
    const auto second =
        run({program("vsplitd"),
             "--root",
             root_.string(),
             "--listen",
             "127.0.0.1:" + std::to_string(first.port())},
            logs_);
    EXPECT_GT(second.status, 0);
    EXPECT_FALSE(second.errors.empty());
}

}  // namespace
}  // namespace vsplit::test
