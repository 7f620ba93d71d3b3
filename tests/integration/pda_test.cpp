// The simulated PDA against a real daemon: what it counts, what it saves, how it survives cuts.
#include "codec/stream_parts.h"
#include "core/file_io.h"
#include "integration/cutting_proxy.h"
#include "integration/model_folder.h"
#include "integration/server_process.h"
#include "precompute/mesh_io.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <future>
#include <optional>
#include <thread>

namespace vsplit::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::seconds;

class Pda : public ModelFolderTest
{
protected:
    /// Arguments of a vsplit-pda that draws one frame a level and reports as JSON.
    [[nodiscard]] static std::vector<std::string> command(
        std::uint16_t port, const std::string& model, const std::vector<std::string>& options = {}
    )
    {
        std::vector<std::string> arguments{
            program("vsplit-pda"), ServerProcess::url(port, model), "--frames", "1", "--json", "-"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    }

    /// Expects two mesh files to hold the same positions (in single precision, which is what PLY files
    /// of `vsplit decode` have) and the same triangles in the same order.
    static void expect_same_mesh(const fs::path& first, const fs::path& second)
    {
        const auto a = precompute::read_mesh(first);
        const auto b = precompute::read_mesh(second);
        ASSERT_TRUE(a.has_value() && b.has_value()) << first << " " << second;
        const auto single = [](const IndexedMesh& mesh) {
            std::vector<std::array<float, 3>> positions;
            for (const auto& [x, y, z] : mesh.positions)
            {
                positions.push_back(
                    {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}
                );
            }
            return positions;
        };
        EXPECT_EQ(single(*a), single(*b));
        EXPECT_EQ(a->triangles, b->triangles);
    }

    [[nodiscard]] Finished decode(
        const EncodedModel& model, const fs::path& out, const std::vector<std::string>& options = {}
    ) const
    {
        std::vector<std::string> arguments{
            program("vsplit"), "decode", model.path.string(), "-o", out.string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(arguments, logs_);
    }
};

TEST_F(Pda, CountsForEveryLevelTheBytesThatTheIndexPromises)
{
    const auto model = encode("beast.ply", "beast");
    const ServerProcess server(root_, logs_);
    const auto pda = run(command(server.port(), "beast"), logs_);
    ASSERT_EQ(pda.status, 0) << pda.errors;
    const auto report = json::parse(pda.output);
    const auto& levels = report.at("levels");
    ASSERT_EQ(levels.size(), model.info.levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i)
    {
        const auto& expected = model.info.levels[i];
        EXPECT_EQ(levels[i].at("level"), expected.level);
        EXPECT_EQ(levels[i].at("vertices"), expected.vertices);
        EXPECT_EQ(levels[i].at("faces"), expected.faces);
        EXPECT_EQ(levels[i].at("chunk_bytes"), expected.chunk_bytes);
        EXPECT_EQ(levels[i].at("cumulative_bytes"), expected.cumulative_bytes);
        EXPECT_GE(levels[i].at("frames"), 1);
    }
    const auto& totals = report.at("totals");
    EXPECT_EQ(totals.at("payload_bytes"), model.bytes.size());
    EXPECT_EQ(totals.at("reconnects"), 0);
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_GE(totals.at("wire_bytes").get<double>(), static_cast<double>(model.bytes.size()));
    EXPECT_LE(
        totals.at("wire_bytes").get<double>(), 1.01 * static_cast<double>(model.bytes.size()) + 64.0
    );
}

// Real attributes would do as well; these are long, and nothing reads them.
TEST_F(Pda, LeavesOutTheChunksThatItIsToldToLeaveOut)
{
    const auto model = encode("beast.ply", "beast");
    StreamParts parts = take_apart(model.bytes);
    const std::size_t shape_chunks = parts.chunks.size();
    constexpr std::size_t kAttributeBytes = 1000000;
    for (std::size_t place = 1; place <= shape_chunks; place += 2)
    {
        codec::ChunkInfo row = parts.info.chunks[place - 1];
        row.kind = proto::ChunkKind::Attributes;
        row.codec = 200;  // Of a version to come.
        const auto at = static_cast<std::ptrdiff_t>(place);
        parts.info.chunks.insert(parts.info.chunks.begin() + at, row);
        parts.chunks.insert(parts.chunks.begin() + at, Bytes(kAttributeBytes, std::byte{1}));
    }
    const Bytes file = put_together(parts);
    ASSERT_TRUE(write_file_atomically(root_ / "long.vsplit", file).has_value());
    const ServerProcess server(root_, logs_);
    // Slow enough that the first of them is still on its way when the header has come.
    const auto pda =
        run(command(server.port(), "long", {"--no-attributes", "--link", "8000:10"}), logs_);
    ASSERT_EQ(pda.status, 0) << pda.errors;
    const auto totals = json::parse(pda.output).at("totals");
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_EQ(totals.at("geometry_bytes"), model.bytes.size() - model.info.header_bytes);
    const std::size_t left_out = parts.chunks.size() - shape_chunks;
    ASSERT_GE(left_out, 3U);
    // What still came before the Cancel did is at most what the kernels hold.
    EXPECT_LE(totals.at("payload_bytes"), file.size() - (left_out - 1) * kAttributeBytes);
    EXPECT_EQ(totals.at("reconnects"), 0);
}

TEST_F(Pda, ShowsAtEveryLevelTheMeshThatTheDecoderGives)
{
    const auto model = encode("bone.ply", "bone");
    const ServerProcess server(root_, logs_);
    for (const auto& level : model.info.levels)
    {
        SCOPED_TRACE("level " + std::to_string(level.level));
        const std::vector<std::string> at{"--level", std::to_string(level.level)};
        const fs::path reference = folder_ / "reference.ply";
        const fs::path saved = folder_ / "saved.ply";
        ASSERT_EQ(decode(model, reference, at).status, 0);
        auto options = at;
        options.insert(options.end(), {"--save", saved.string()});
        const auto pda = run(command(server.port(), "bone", options), logs_);
        ASSERT_EQ(pda.status, 0) << pda.errors;
        expect_same_mesh(reference, saved);
    }
}

TEST_F(Pda, ReconnectsAfterACutAtAndInsideEveryChunkWithoutFetchingAnythingTwice)
{
    const auto model = encode("bone.ply", "bone");
    const ServerProcess server(root_, logs_);
    std::vector<std::uint64_t> cuts;
    for (const auto& chunk : model.info.chunks)
    {
        cuts.push_back(chunk.offset);
        cuts.push_back(chunk.offset + chunk.bytes / 2);
    }
    const CuttingProxy proxy(server.port(), cuts);
    const fs::path saved = folder_ / "saved.ply";
    const fs::path reference = folder_ / "reference.ply";
    ASSERT_EQ(decode(model, reference).status, 0);
    const auto pda = run(command(proxy.port(), "bone", {"--save", saved.string()}), logs_);
    ASSERT_EQ(pda.status, 0) << pda.errors;
    const auto totals = json::parse(pda.output).at("totals");
    EXPECT_EQ(totals.at("reconnects"), cuts.size());
    EXPECT_EQ(totals.at("payload_bytes"), model.bytes.size());
    EXPECT_EQ(proxy.payload_bytes(), model.bytes.size());
    expect_same_mesh(reference, saved);
}

TEST_F(Pda, GoesOnWhenTheServerIsKilledAndStartedAgain)
{
    const auto model = encode("beast.ply", "beast");
    std::optional<ServerProcess> server(std::in_place, root_, logs_);
    const auto port = server->port();
    std::promise<void> killed;
    const CuttingProxy proxy(port, {model.bytes.size() / 2}, [&] {
        server->process().signal(SIGKILL);
        static_cast<void>(server->process().wait(seconds(60)));
        killed.set_value();
    });
    const fs::path saved = folder_ / "saved.ply";
    ChildProcess pda(command(proxy.port(), "beast", {"--save", saved.string()}), logs_);
    ASSERT_EQ(killed.get_future().wait_for(seconds(120)), std::future_status::ready);
    // Long enough that an attempt to reconnect finds nobody.
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    server.emplace(root_, logs_, std::vector<std::string>{}, port);

    ASSERT_EQ(pda.wait(seconds(120)), 0) << pda.errors();
    const auto totals = json::parse(pda.output()).at("totals");
    EXPECT_GE(totals.at("reconnects"), 1);
    EXPECT_EQ(totals.at("complete"), true);
    EXPECT_EQ(totals.at("payload_bytes"), model.bytes.size());
    const fs::path reference = folder_ / "reference.ply";
    ASSERT_EQ(decode(model, reference).status, 0);
    expect_same_mesh(reference, saved);
}

TEST_F(Pda, FailsWithAReasonWhenThereIsNoSuchModel)
{
    const ServerProcess server(root_, logs_);
    const auto pda = run(command(server.port(), "missing"), logs_);
    EXPECT_EQ(pda.status, exit_status(ErrorCode::NotFound));
    EXPECT_NE(pda.errors.find("missing"), std::string::npos) << pda.errors;
}

}  // namespace
}  // namespace vsplit::test
