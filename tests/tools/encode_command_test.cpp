#include "precompute/mesh_io.h"
#include "tools/tool_fixture.h"

#include <array>

namespace vsplit::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class EncodeCommand : public VsplitTool
{
};

/// Checks that an object has exactly these keys, and these first.
void expect_keys(const nlohmann::json& object, const std::vector<std::string>& keys)
{
    for (const std::string& key : keys)
    {
        EXPECT_TRUE(object.contains(key)) << key << " is missing in " << object.dump();
    }
}

TEST_F(EncodeCommand, ListsTheFilesThatTheModelRefersToWhetherTheyAreThereOrNot)
{
    const std::string obj = save(
        "square.obj",
        "mtllib square.mtl\nmtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3 4/4\n"
    );
    save("square.mtl", "newmtl skin\nmap_Kd maps\\skin.png\n");
    const Finished encoded = run({"encode", obj, "--quiet", "--companions", path("files")});
    EXPECT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_EQ(load("files"), "square.mtl\nmaps/skin.png\n");

    const std::string gltf = save(
        "lost.gltf",
        R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "lost.bin", "byteLength": 36}]})"
    );
    EXPECT_NE(run({"encode", gltf, "--quiet", "--companions", path("files")}).status, 0);
    EXPECT_EQ(load("files"), "lost.bin\n");
}

TEST_F(EncodeCommand, EncodesEveryFormatAndVerifies)
{
    for (const std::string extension : {"ply", "obj", "off", "stl"})
    {
        const std::string mesh = path("torus." + extension);
        ASSERT_TRUE(precompute::write_mesh(mesh, bumpy_torus()));
        const Finished encoded = run({"encode", mesh});
        EXPECT_EQ(encoded.status, 0) << encoded.err;
        EXPECT_EQ(encoded.err, "");
        const Finished verified = run({"verify", path("torus.vsplit"), "--against", mesh});
        EXPECT_EQ(verified.status, 0) << verified.err;
        EXPECT_THAT(verified.out, HasSubstr("verified: "));
        std::filesystem::remove(path("torus.vsplit"));
    }
}

TEST_F(EncodeCommand, PrintsTheRepairReportAndATableForPeople)
{
    const std::string mesh = save(
        "dirty.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 9 9\nv 0 0 0\nf 1 3 2\nf 6 2 4\nf 2 3 4\n"
        "f 3 1 4\nf 1 6 2\nf 2 3 1\n"
    );
    const Finished encoded = run({"encode", mesh, "-o", path("dirty.vsplit")});
    EXPECT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_THAT(encoded.out, HasSubstr("6 vertices, 6 faces"));
    EXPECT_THAT(
        encoded.out,
        HasSubstr("repair: welded 1 vertices at equal positions, dropped 1 isolated vertices, "
                  "dropped 1 degenerate faces, dropped 1 duplicate faces\n")
    );
    EXPECT_THAT(encoded.out, HasSubstr("level"));
    EXPECT_THAT(encoded.out, HasSubstr("bits a vertex"));
}

TEST_F(EncodeCommand, GivesTheJsonThatProgramsRelyOn)
{
    const nlohmann::json json = encode_torus();
    expect_keys(
        json,
        {"input",
         "repair",
         "vertices",
         "faces",
         "position_bits",
         "metric",
         "bytes",
         "bits_per_vertex",
         "base",
         "levels",
         "seconds",
         "peak_memory_bytes"}
    );
    expect_keys(json["input"], {"vertices", "faces", "components", "boundary_edges"});
    expect_keys(json["base"], {"vertices", "faces", "bytes"});
    expect_keys(json["seconds"], {"read", "repair", "write", "total"});
    EXPECT_EQ(json["input"]["vertices"], 512);
    EXPECT_EQ(json["input"]["faces"], 1024);
    EXPECT_EQ(json["input"]["components"], 1);
    EXPECT_EQ(json["input"]["boundary_edges"], 0);
    EXPECT_EQ(json["vertices"], 512);
    EXPECT_EQ(json["faces"], 1024);
    EXPECT_EQ(json["position_bits"], 12);
    EXPECT_EQ(json["metric"], "curvature");
    EXPECT_EQ(json["bytes"], std::filesystem::file_size(path("torus.vsplit")));
    EXPECT_DOUBLE_EQ(json["bits_per_vertex"], json["bytes"].get<double>() * 8.0 / 512.0);
    EXPECT_GT(json["peak_memory_bytes"], 1000000);

    ASSERT_GE(json["levels"].size(), 2U);
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < json["levels"].size(); ++i)
    {
        const nlohmann::json& level = json["levels"][i];
        expect_keys(
            level,
            {"level",
             "vertices",
             "faces",
             "chunk_bytes",
             "cumulative_bytes",
             "rms_percent",
             "max_percent"}
        );
        EXPECT_EQ(level["level"], i);
        EXPECT_GT(level["cumulative_bytes"], before);
        before = level["cumulative_bytes"];
    }
    EXPECT_EQ(json["levels"].back()["vertices"], 512);
    EXPECT_EQ(json["levels"].back()["cumulative_bytes"], json["bytes"]);
    EXPECT_LT(json["levels"].back()["rms_percent"], json["levels"][0]["rms_percent"]);
}

TEST_F(EncodeCommand, WritesJsonToAFileAndPrintsNothingWhenQuiet)
{
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    const Finished encoded =
        run({"encode", path("torus.ply"), "--quiet", "--json", path("report.json")});
    EXPECT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_EQ(encoded.out + encoded.err, "");
    EXPECT_THAT(files(), ElementsAre("report.json", "torus.ply", "torus.vsplit"));
    EXPECT_EQ(nlohmann::json::parse(load("report.json"))["vertices"], 512);
}

TEST_F(EncodeCommand, GivesTheSameBytesForAnyNumberOfThreads)
{
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    for (const std::string threads : {"1", "2", "7"})
    {
        const Finished encoded =
            run({"encode", path("torus.ply"), "-o", path(threads + ".vsplit"), "--threads", threads}
            );
        EXPECT_EQ(encoded.status, 0) << encoded.err;
    }
    EXPECT_EQ(load("1.vsplit"), load("2.vsplit"));
    EXPECT_EQ(load("1.vsplit"), load("7.vsplit"));
}

TEST_F(EncodeCommand, KeepsMarkedRegionsLongest)
{
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    const auto encode = [&](const std::vector<std::string>& extra) {
        std::vector<std::string> arguments{"encode", path("torus.ply"), "--json", "-"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        const Finished encoded = run(arguments);
        EXPECT_EQ(encoded.status, 0) << encoded.err;
        const Finished verified =
            run({"verify", path("torus.vsplit"), "--against", path("torus.ply")});
        EXPECT_EQ(verified.status, 0) << verified.err;
        return std::pair(encoded.json()["kept_vertices"], load("torus.vsplit"));
    };
    const auto plain = encode({});
    EXPECT_EQ(plain.first, 0);
    const auto ball = encode({"--keep-region", "-3,0,0,1.5"});
    EXPECT_GT(ball.first, 20);
    EXPECT_LT(ball.first, 200);
    EXPECT_NE(ball.second, plain.second);
    const auto balls = encode({"--keep-region", "-3,0,0,1.5", "--keep-region", "3,0,0,1.5"});
    EXPECT_GT(balls.first, ball.first);

    std::string mask;
    for (int vertex = 0; vertex < 512; ++vertex)
    {
        mask += vertex < 100 ? "1\n" : "0\n";
    }
    save("mask.txt", mask);
    const auto masked = encode({"--keep-mask", path("mask.txt")});
    EXPECT_EQ(masked.first, 100);
    EXPECT_NE(masked.second, plain.second);
}

TEST_F(EncodeCommand, RefusesRegionsThatAreNone)
{
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    const auto refused = [&](const std::string& option, const std::string& value, int status) {
        const Finished finished = run({"encode", path("torus.ply"), option, value});
        EXPECT_EQ(finished.status, status) << value;
        EXPECT_EQ(files(), (std::vector<std::string>{"mask.txt", "torus.ply"}));
        return finished.err;
    };
    save("mask.txt", "0 1 0 1\n");
    EXPECT_THAT(
        refused("--keep-mask", path("mask.txt"), 3), HasSubstr("has 4 numbers for 512 vertices")
    );
    EXPECT_THAT(refused("--keep-mask", path("none.txt"), 5), HasSubstr("there is no file"));
    EXPECT_THAT(refused("--keep-region", "50,0,0,1", 3), HasSubstr("holds no vertex of"));
    EXPECT_THAT(refused("--keep-region", "1,2,3", 2), HasSubstr("1,2,3 is not x,y,z,r"));
}

TEST_F(EncodeCommand, ObeysMetricPositionBitsAndBaseVertices)
{
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    const std::vector<std::vector<std::string>> choices{
        {"--metric", "curvature-bspline"},
        {"--metric", "quadrics"},
        {"--metric", "qem"},
        {"--metric", "normal"},
        {"--metric", "edge-length"},
        {"--metric", "paper"},
        {"--position-bits", "8"},
        {"--position-bits", "20"},
        {"--base-vertices", "200"},
        {"--level-vertices", "100,300"}};
    for (const auto& choice : choices)
    {
        const Finished encoded = run(
            {"encode",
             path("torus.ply"),
             "-o",
             path("a.vsplit"),
             "--json",
             "-",
             choice[0],
             choice[1]}
        );
        ASSERT_EQ(encoded.status, 0) << choice[1] << ": " << encoded.err;
        const Finished verified = run({"verify", path("a.vsplit"), "--against", path("torus.ply")});
        EXPECT_EQ(verified.status, 0) << choice[1] << ": " << verified.err;
        const nlohmann::json json = encoded.json();
        EXPECT_EQ(json["metric"], choice[0] == "--metric" ? choice[1] : "curvature");
        const bool bits = choice[0] == "--position-bits";
        EXPECT_EQ(json["position_bits"], bits ? std::stoi(choice[1]) : 12);
        if (choice[0] == "--base-vertices")
        {
            EXPECT_GE(json["base"]["vertices"], 190);
        }
    }
}

TEST_F(EncodeCommand, GivesEveryLevelOneChunkWhenUncut)
{
    const std::string input = std::string(VSPLIT_SOURCE_DIR) + "/assets/beast.ply";
    ASSERT_EQ(run({"encode", input, "-o", path("cut.vsplit"), "--quiet"}).status, 0);
    ASSERT_EQ(run({"encode", input, "-o", path("uncut.vsplit"), "--quiet", "--uncut"}).status, 0);
    EXPECT_EQ(run({"verify", path("uncut.vsplit"), "--against", input}).status, 0);
    const auto cut = run({"inspect", path("cut.vsplit"), "--json", "-"}).json();
    const auto uncut = run({"inspect", path("uncut.vsplit"), "--json", "-"}).json();
    EXPECT_GT(cut["chunks"].size(), cut["levels"].size());
    EXPECT_EQ(uncut["chunks"].size(), uncut["levels"].size());
    EXPECT_EQ(uncut["levels"].size(), cut["levels"].size());
}

TEST_F(EncodeCommand, ReplacesAnOldOutputButNeverItsInput)
{
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), bumpy_torus()));
    save("torus.vsplit", "old");
    EXPECT_EQ(run({"encode", path("torus.ply")}).status, 0);
    EXPECT_NE(load("torus.vsplit"), "old");
    const std::string before = load("torus.ply");
    expect_one_line_error(run({"encode", path("torus.ply"), "-o", path("torus.ply")}), 5);
    EXPECT_EQ(load("torus.ply"), before);
}

TEST_F(EncodeCommand, ExitsWithTwoOnAWrongCommandLine)
{
    const std::vector<std::vector<std::string>> wrong{
        {},
        {"explode"},
        {"encode"},
        {"encode", "a.ply", "--position-bits", "7"},
        {"encode", "a.ply", "--position-bits", "21"},
        {"encode", "a.ply", "--metric", "magic"},
        {"encode", "a.ply", "--threads", "0"},
        {"encode", "a.ply", "--seed", "1"},
    };
    for (const auto& arguments : wrong)
    {
        const Finished finished = run(arguments);
        EXPECT_EQ(finished.status, 2) << ::testing::PrintToString(arguments);
        EXPECT_NE(finished.err, "");
    }
    EXPECT_EQ(run({"--help"}).status, 0);
    EXPECT_EQ(run({"encode", "--help"}).status, 0);
    EXPECT_THAT(run({"--version"}).out, HasSubstr("vsplit 0."));
}

}  // namespace
}  // namespace vsplit::test
