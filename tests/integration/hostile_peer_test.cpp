// Clients that misbehave, and names that try to leave the root.
#include "core/error.h"
#include "core/file_io.h"
#include "integration/model_folder.h"
#include "integration/raw_client.h"
#include "integration/server_process.h"

#include <chrono>
#include <random>
#include <thread>

namespace vsplit::test {
namespace {

namespace fs = std::filesystem;
using HostilePeer = ModelFolderTest;

/// Small enough that a client that stops reading blocks its session with most of the large model
/// unsent.
constexpr int kSmallReceiveBuffer = 4096;

class SlowReader : public ModelFolderTest
{
protected:
    void SetUp() override
    {
        ModelFolderTest::SetUp();
        large_ = encode_large("large");
    }

    EncodedModel large_;
};

TEST_F(SlowReader, DelaysNobodyElseAndLosesNothing)
{
    ServerProcess server(root_, logs_);
    std::vector<RawClient> stuck;
    for (int i = 0; i < 8; ++i)
    {
        stuck.emplace_back(server.port(), kSmallReceiveBuffer);
        ASSERT_TRUE(stuck.back().open({.model = "large"}));
    }
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_EQ(RawClient(server.port()).transfer({.model = "large"}).payload, large_.bytes);
    }
    for (auto& client : stuck)
    {
        EXPECT_EQ(client.finish().payload, large_.bytes);
    }
}

TEST_F(SlowReader, IsCutOffAfterTheIdleTimeout)
{
    ServerProcess server(root_, logs_, {"--idle-timeout", "1"});
    RawClient stuck(server.port(), kSmallReceiveBuffer);
    ASSERT_TRUE(stuck.open({.model = "large"}));
    std::this_thread::sleep_for(std::chrono::seconds(3));
    const auto transfer = stuck.finish();
    EXPECT_FALSE(transfer.done.has_value());
    EXPECT_LT(transfer.payload.size(), large_.bytes.size());
    EXPECT_EQ(RawClient(server.port()).transfer({.model = "large"}).payload, large_.bytes);
}

TEST_F(HostilePeer, ThatSendsGarbageIsCutOffAndTheOthersAreServed)
{
    const auto model = encode("bone.ply", "bone");
    ServerProcess server(root_, logs_);
    std::mt19937 random(42);
    for (int round = 0; round < 32; ++round)
    {
        std::vector<std::byte> garbage(1 + random() % 5000);
        for (auto& byte : garbage)
        {
            byte = static_cast<std::byte>(random());
        }
        // An unknown frame type, so that no random length lets the server wait for more.
        garbage[std::min<std::size_t>(3, garbage.size() - 1)] = std::byte{0x7F};
        garbage.resize(std::max<std::size_t>(garbage.size(), 4), std::byte{0x7F});
        RawClient client(server.port());
        static_cast<void>(client.send(garbage));
        const auto answer = client.finish();
        EXPECT_TRUE(answer.payload.empty());
        if (answer.failure)
        {
            EXPECT_TRUE(answer.failure->closing);
        }
    }
    EXPECT_EQ(RawClient(server.port()).transfer({.model = "bone"}).payload, model.bytes);
}

TEST_F(HostilePeer, ThatCutsItsRequestAnywhereDoesNoHarm)
{
    const auto model = encode("bone.ply", "bone");
    ServerProcess server(root_, logs_);
    const auto request = wire::encode(wire::Open{.model = "bone"}).value();
    for (std::size_t length = 0; length < request.size(); ++length)
    {
        const RawClient client(server.port());
        ASSERT_TRUE(client.send(std::span(request).first(length)));
    }
    EXPECT_EQ(RawClient(server.port()).transfer({.model = "bone"}).payload, model.bytes);
    EXPECT_TRUE(server.process().running());
}

TEST_F(HostilePeer, GetsNothingFromOutsideTheRoot)
{
    const auto model = encode("bone.ply", "bone");
    fs::create_directories(root_ / "inside");
    ASSERT_TRUE(write_file_atomically(folder_ / "secret.vsplit", model.bytes).has_value());
    fs::create_symlink(folder_ / "secret.vsplit", root_ / "link.vsplit");
    fs::create_directory_symlink(folder_, root_ / "way-out");
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    const std::string outside = (folder_ / "secret.vsplit").string();
    for (const std::string& name :
         {std::string("../secret"),
          std::string("../secret.vsplit"),
          std::string("inside/../../secret"),
          std::string("inside/../bone"),
          std::string("./bone"),
          std::string("inside//../bone"),
          std::string("/etc/passwd"),
          outside,
          std::string("link"),
          std::string("link.vsplit"),
          std::string("way-out/secret"),
          std::string(".."),
          std::string("inside"),
          std::string("..\\secret"),
          std::string("missing")})
    {
        const auto answer = client.transfer({.model = name});
        ASSERT_TRUE(answer.failure.has_value()) << name;
        EXPECT_EQ(answer.failure->code, static_cast<std::uint16_t>(ErrorCode::NotFound)) << name;
        if (name != outside)
        {
            EXPECT_EQ(answer.failure->message.find(folder_.string()), std::string::npos) << name;
        }
    }
    EXPECT_EQ(client.transfer({.model = "bone"}).payload, model.bytes);
}

TEST_F(HostilePeer, GetsACodedErrorForADamagedFile)
{
    auto model = encode("bone.ply", "bone");
    model.bytes[model.info.header_bytes - 1] ^= std::byte{0x10};
    ASSERT_TRUE(write_file_atomically(root_ / "damaged.vsplit", model.bytes).has_value());
    ASSERT_TRUE(write_file_atomically(root_ / "empty.vsplit", {}).has_value());
    const ServerProcess server(root_, logs_);
    RawClient client(server.port());
    for (const std::string name : {"damaged", "empty"})
    {
        const auto answer = client.transfer({.model = name});
        ASSERT_TRUE(answer.failure.has_value()) << name;
        EXPECT_LT(answer.failure->code, 20) << name;
        EXPECT_FALSE(answer.failure->closing) << name;
    }
    EXPECT_EQ(client.transfer({.model = "bone"}).done, wire::DoneReason::EndReached);
}

}  // namespace
}  // namespace vsplit::test
