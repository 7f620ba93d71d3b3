#include "precompute/mesh_io.h"
#include "tools/tool_fixture.h"

namespace vsplit::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class DecodeCommand : public VsplitTool
{
protected:
    /// Decodes `torus.vsplit` with extra arguments and returns the JSON.
    [[nodiscard]] nlohmann::json decode(const std::vector<std::string>& extra) const
    {
        std::vector<std::string> arguments{"decode", path("torus.vsplit"), "--json", "-"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        const Finished finished = run(arguments);
        EXPECT_EQ(finished.status, 0) << finished.err;
        return finished.json();
    }
};

TEST_F(DecodeCommand, GivesTheJsonThatProgramsRelyOn)
{
    const nlohmann::json encoded = encode_torus();
    const nlohmann::json json = decode({"--repeat", "5"});
    EXPECT_EQ(json["level"], encoded["levels"].back()["level"]);
    EXPECT_EQ(json["vertices"], 512);
    EXPECT_EQ(json["faces"], 1024);
    EXPECT_EQ(json["bytes_used"], encoded["bytes"]);
    EXPECT_GT(json["seconds"]["decode"], 0.0);
    EXPECT_GT(json["decoder_heap_peak_bytes"], 512 * 12);
    EXPECT_LT(json["decoder_heap_peak_bytes"], 10000000);
}

TEST_F(DecodeCommand, WritesTheSameMeshInEveryFormat)
{
    encode_torus();
    for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl"})
    {
        const Finished finished = run({"decode", path("torus.vsplit"), "-o", path(name)});
        ASSERT_EQ(finished.status, 0) << finished.err;
        const auto mesh = precompute::read_mesh(path(name));
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), 1024U);
        EXPECT_EQ(mesh->positions.size(), name == "a.stl" ? 3072U : 512U);
        for (const auto& [x, y, z] : mesh->positions)
        {
            EXPECT_NEAR(std::hypot(std::hypot(x, y) - 3.0, z), 1.0, 0.11);
        }
    }
}

TEST_F(DecodeCommand, StopsAtEveryLevel)
{
    const nlohmann::json encoded = encode_torus();
    for (const nlohmann::json& level : encoded["levels"])
    {
        const nlohmann::json json =
            decode({"--level", level["level"].dump(), "-o", path("level.ply")});
        EXPECT_EQ(json["level"], level["level"]);
        EXPECT_EQ(json["vertices"], level["vertices"]);
        EXPECT_EQ(json["faces"], level["faces"]);
        EXPECT_EQ(json["bytes_used"], level["cumulative_bytes"]);
        const auto mesh = precompute::read_mesh(path("level.ply"));
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), level["faces"]);
    }
}

TEST_F(DecodeCommand, StopsByBytesFacesAndError)
{
    const nlohmann::json encoded = encode_torus();
    const std::size_t middle = encoded["levels"].size() / 2;
    const nlohmann::json& level = encoded["levels"][middle];

    nlohmann::json json = decode({"--bytes", level["cumulative_bytes"].dump()});
    EXPECT_EQ(json["level"], level["level"]);
    json = decode({"--bytes", std::to_string(level["cumulative_bytes"].get<int>() - 1)});
    EXPECT_LT(json["bytes_used"], level["cumulative_bytes"]);
    json = decode({"--bytes", "0"});
    EXPECT_EQ(json["level"], 0) << "header and base are always shown";

    json = decode({"--faces", level["faces"].dump()});
    EXPECT_EQ(json["level"], level["level"]);
    json = decode({"--faces", std::to_string(level["faces"].get<int>() - 1)});
    EXPECT_LT(json["faces"], level["faces"]);

    json = decode({"--error", std::to_string(level["rms_percent"].get<double>() * 1.001) + "%"});
    EXPECT_LE(json["level"], level["level"]);
    EXPECT_LE(
        encoded["levels"][json["level"].get<std::size_t>()]["rms_percent"],
        level["rms_percent"].get<double>() * 1.001
    );
    json = decode({"--error", "1000000"});
    EXPECT_EQ(json["level"], 0);
    json = decode({"--error", "0"});
    EXPECT_EQ(json["level"], encoded["levels"].back()["level"]);
}

TEST_F(DecodeCommand, ShowsTheLastCompleteLevelOfACutFile)
{
    const nlohmann::json encoded = encode_torus();
    const std::string whole = load("torus.vsplit");
    for (const nlohmann::json& level : encoded["levels"])
    {
        const auto end = level["cumulative_bytes"].get<std::size_t>();
        save("torus.vsplit", whole.substr(0, end));
        EXPECT_EQ(decode({})["level"], level["level"]);
        save("torus.vsplit", whole.substr(0, end - 1));
        const Finished finished = run({"decode", path("torus.vsplit"), "--json", "-"});
        if (level["level"] == 0)
        {
            expect_one_line_error(finished, 4);
            continue;
        }
        EXPECT_EQ(finished.status, 0) << finished.err;
        EXPECT_EQ(finished.json()["level"], level["level"].get<int>() - 1);
    }
}

TEST_F(DecodeCommand, ShowsOfACutFileEveryCompleteChunk)
{
    const std::string input = std::string(VSPLIT_SOURCE_DIR) + "/assets/beast.ply";
    ASSERT_EQ(run({"encode", input, "-o", path("torus.vsplit"), "--quiet"}).status, 0);
    const std::string whole = load("torus.vsplit");
    const auto chunks = run({"inspect", path("torus.vsplit"), "--json", "-"}).json()["chunks"];
    int within_levels = 0;
    for (const nlohmann::json& chunk : chunks)
    {
        const std::size_t end =
            chunk["offset"].get<std::size_t>() + chunk["bytes"].get<std::size_t>();
        save("torus.vsplit", whole.substr(0, end));
        const nlohmann::json json = decode({});
        EXPECT_EQ(json["bytes_used"], end);
        EXPECT_EQ(json["vertices"], chunk["vertices"]);
        within_levels += chunk["ends_level"] ? 0 : 1;
    }
    EXPECT_GT(within_levels, 0);
}

TEST_F(DecodeCommand, RefusesDamagedStreamsAndLeavesNoOutput)
{
    encode_torus();
    const std::string whole = load("torus.vsplit");
    std::string damaged = whole;
    damaged[damaged.size() - 5] = static_cast<char>(damaged[damaged.size() - 5] ^ 1);
    save("damaged.vsplit", damaged);
    save("empty.vsplit", "");
    save("noise.vsplit", "This is no stream but a text that is long enough for a header.");
    for (const std::string name : {"damaged.vsplit", "empty.vsplit", "noise.vsplit"})
    {
        expect_one_line_error(run({"decode", path(name), "-o", path("out.ply")}), 4);
        EXPECT_FALSE(std::filesystem::exists(path("out.ply"))) << name;
    }
    expect_one_line_error(run({"decode", path("none.vsplit"), "-o", path("out.ply")}), 5);
    expect_one_line_error(run({"decode", path("torus.vsplit"), "-o", path("out.fbx")}), 3);
    expect_one_line_error(run({"decode", path("torus.vsplit"), "-o", path("no/out.ply")}), 5);
    EXPECT_THAT(
        files(),
        ElementsAre("damaged.vsplit", "empty.vsplit", "noise.vsplit", "torus.ply", "torus.vsplit")
    );
}

TEST_F(DecodeCommand, ExitsWithTwoOnAWrongCommandLine)
{
    const std::vector<std::vector<std::string>> wrong{
        {"decode", "a.vsplit"},
        {"decode", "a.vsplit", "-o", "a.ply", "--level", "1", "--faces", "10"},
        {"decode", "a.vsplit", "-o", "a.ply", "--error", "small"},
        {"decode", "a.vsplit", "-o", "a.ply", "--error", "nan"},
        {"decode", "a.vsplit", "-o", "a.ply", "--level", "-1"},
        {"decode", "a.vsplit", "-o", "a.ply", "--repeat", "0"},
    };
    for (const auto& arguments : wrong)
    {
        EXPECT_EQ(run(arguments).status, 2) << ::testing::PrintToString(arguments);
    }
}

TEST_F(DecodeCommand, StitchesTheCopiesOfCutVerticesTogetherAgain)
{
    // Two tori that share one vertex, and a fin on an edge of the first.
    IndexedMesh mesh = bumpy_torus();
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const IndexedMesh second = bumpy_torus();
    for (const auto& [x, y, z] : second.positions)
    {
        mesh.positions.push_back({x + 2.0 * second.positions[0][0], y, z});
    }
    mesh.positions[count + 16 * 16] = mesh.positions[0];
    for (const auto& [a, b, c] : second.triangles)
    {
        mesh.triangles.push_back({a + count, b + count, c + count});
    }
    mesh.positions.push_back({0.0, 0.0, 5.0});
    mesh.triangles.push_back({40, 41, 2 * count});
    ASSERT_TRUE(precompute::write_mesh(path("pair.ply"), mesh));

    const Finished encoded = run({"encode", path("pair.ply"), "--json", "-"});
    ASSERT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_EQ(encoded.json()["repair"]["added_vertices"], 3);
    const Finished verified = run({"verify", path("pair.vsplit"), "--against", path("pair.ply")});
    EXPECT_EQ(verified.status, 0) << verified.err;
    ASSERT_EQ(run({"decode", path("pair.vsplit"), "-o", path("back.ply")}).status, 0);
    const auto back = precompute::read_mesh(path("back.ply"));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->positions.size(), 2 * std::size_t{count});
    EXPECT_EQ(back->triangles.size(), mesh.triangles.size());
}

TEST_F(DecodeCommand, InspectShowsHeaderAndIndexWithoutTheChunks)
{
    const nlohmann::json encoded = encode_torus();
    const auto header = encoded["header_bytes"].get<std::size_t>();
    save("head.vsplit", load("torus.vsplit").substr(0, header));
    const Finished people = run({"inspect", path("head.vsplit")});
    EXPECT_EQ(people.status, 0) << people.err;
    EXPECT_THAT(people.out, HasSubstr("512 vertices, 1024 faces, 12 bits"));
    const Finished finished = run({"inspect", path("head.vsplit"), "--json", "-"});
    EXPECT_EQ(finished.status, 0) << finished.err;
    const nlohmann::json json = finished.json();
    EXPECT_EQ(json["levels"], encoded["levels"]);
    EXPECT_EQ(json["bytes"], encoded["bytes"]);
    EXPECT_EQ(json["bytes_present"], header);
    EXPECT_EQ(json["chunks"][0]["kind"], "base");
    save("head.vsplit", load("torus.vsplit").substr(0, header - 1));
    expect_one_line_error(run({"inspect", path("head.vsplit")}), 4);
}

}  // namespace
}  // namespace vsplit::test
