#include "precompute/mesh_io.h"
#include "tools/tool_fixture.h"

#include <random>
#include <utility>

namespace vsplit::test {
namespace {

using ::testing::HasSubstr;

class VerifyCommand : public VsplitTool
{
protected:
    /// Verifies `torus.vsplit` against another mesh.
    [[nodiscard]] Finished against(const IndexedMesh& mesh) const
    {
        EXPECT_TRUE(precompute::write_mesh(path("other.ply"), mesh));
        return run({"verify", path("torus.vsplit"), "--against", path("other.ply")});
    }
};

TEST_F(VerifyCommand, AcceptsTheSourceInAnyOrder)
{
    encode_torus();
    EXPECT_EQ(run({"verify", path("torus.vsplit")}).status, 0);
    IndexedMesh mesh = bumpy_torus();
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    for (auto& [a, b, c] : mesh.triangles)
    {
        std::tie(a, b, c) = std::tuple(b, c, a);
    }
    const Finished finished = against(mesh);
    EXPECT_EQ(finished.status, 0) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("verified: "));
}

TEST_F(VerifyCommand, AcceptsTrianglesOfWhichTheGridMakesTwoCornersOne)
{
    IndexedMesh mesh = bumpy_torus();
    const auto [a, b, c] = mesh.triangles[0];
    mesh.positions[b] = mesh.positions[a];
    mesh.positions[b][0] += 1e-6;
    ASSERT_TRUE(precompute::write_mesh(path("torus.ply"), mesh));
    ASSERT_EQ(run({"encode", path("torus.ply"), "-o", path("torus.vsplit")}).status, 0);
    for (int turn = 0; turn < 3; ++turn)
    {
        for (auto& [x, y, z] : mesh.triangles)
        {
            std::tie(x, y, z) = std::tuple(y, z, x);
        }
        const Finished finished = against(mesh);
        EXPECT_EQ(finished.status, 0) << finished.err;
    }
}

TEST_F(VerifyCommand, TellsEveryDifferenceFromTheSource)
{
    encode_torus();
    IndexedMesh mesh = bumpy_torus();
    mesh.positions[100][2] += 0.01;
    expect_one_line_error(against(mesh), 7);

    mesh = bumpy_torus();
    mesh.triangles.pop_back();
    expect_one_line_error(against(mesh), 7);

    mesh = bumpy_torus();
    for (auto& [a, b, c] : mesh.triangles)
    {
        std::swap(b, c);
    }
    expect_one_line_error(against(mesh), 7);

    // The other diagonal of one square: same positions, same counts.
    mesh = bumpy_torus();
    const auto [a, b, c] = mesh.triangles[0];
    const std::uint32_t d = mesh.triangles[1][2];
    mesh.triangles[0] = {a, b, d};
    mesh.triangles[1] = {b, c, d};
    expect_one_line_error(against(mesh), 7);

    mesh = bumpy_torus();
    for (auto& point : mesh.positions)
    {
        point[0] *= 1.5;
    }
    expect_one_line_error(against(mesh), 7);
}

TEST_F(VerifyCommand, RefusesEveryDamagedByteOfTheFile)
{
    encode_torus();
    const std::string whole = load("torus.vsplit");
    std::mt19937 random(3);
    for (std::size_t at = 0; at < whole.size(); at += 1 + random() % 41)
    {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
        save("damaged.vsplit", damaged);
        SCOPED_TRACE(at);
        expect_one_line_error(run({"verify", path("damaged.vsplit")}), 4);
    }
}

TEST_F(VerifyCommand, RefusesCutAndLengthenedFiles)
{
    encode_torus();
    const std::string whole = load("torus.vsplit");
    save("cut.vsplit", whole.substr(0, whole.size() - 1));
    Finished finished = run({"verify", path("cut.vsplit")});
    expect_one_line_error(finished, 4);
    EXPECT_THAT(finished.err, HasSubstr("truncated"));
    save("long.vsplit", whole + "x");
    finished = run({"verify", path("long.vsplit")});
    expect_one_line_error(finished, 4);
    EXPECT_THAT(finished.err, HasSubstr("trailing-bytes"));
    expect_one_line_error(run({"verify", path("none.vsplit")}), 5);
    expect_one_line_error(run({"verify", path("torus.vsplit"), "--against", path("none.ply")}), 5);
}

}  // namespace
}  // namespace vsplit::test
