#include "tools/tool_fixture.h"

#include <random>

namespace vsplit::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class BadInput : public VsplitTool
{
protected:
    /// Encodes a bad file: one line, the exit status, no output, an old output untouched, little
    /// memory.
    void expect_refused(
        const std::string& name, std::string_view contents, int status, const std::string& words
    ) const
    {
        SCOPED_TRACE(name + ": " + std::string(contents.substr(0, 60)));
        save(name, contents);
        save("old.vsplit", "old");
        for (const std::string output : {"old.vsplit", "new.vsplit"})
        {
            const Finished finished = run({"encode", path(name), "-o", path(output)});
            expect_one_line_error(finished, status);
            EXPECT_THAT(finished.err, HasSubstr(words));
            EXPECT_LT(finished.peak_bytes, 300000000U);
        }
        EXPECT_EQ(load("old.vsplit"), "old");
        EXPECT_THAT(files(), ::testing::UnorderedElementsAre(name, "old.vsplit"));
        std::filesystem::remove(path(name));
    }
};

constexpr std::string_view kPly =
    "property float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

TEST_F(BadInput, EmptyAndNotAMesh)
{
    std::mt19937 random(1);
    std::string noise(20000, '\0');
    for (char& byte : noise)
    {
        byte = static_cast<char>(random() & 0xFFU);
    }
    for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl", "a.om"})
    {
        expect_refused(name, "", 3, "the file is empty");
        expect_refused(name, noise, 3, "not-a-mesh: cannot read ");
        expect_refused(name, "just a text\n", 3, "not-a-mesh: cannot read ");
    }
    expect_refused("a.pdf", "just a text\n", 3, "unsupported-input");
}

TEST_F(BadInput, ClaimedTwoThousandMillionVertices)
{
    const std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\n" +
                            std::string(kPly) + std::string(1000, 'x');
    expect_refused("a.ply", ply, 3, "the header claims 2000000000 vertices but the file has 1 kB");
    expect_refused("a.off", "OFF\n2000000000 2000000000 0\n0 0 0\n", 3, "claims 2000000000");
    expect_refused("a.stl", std::string(84, '\x77'), 3, "triangles");
}

TEST_F(BadInput, TruncatedNotFiniteAndOutOfRange)
{
    const std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + std::string(kPly);
    expect_refused("a.ply", ply + std::string(30, '\0'), 3, "cannot read ");
    expect_refused("a.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", 3, "bad-coordinate");
    expect_refused("a.obj", "v 0 0 0\nv 1 0 1e39\nv 0 1 0\nf 1 2 3\n", 3, "bad-coordinate");
    expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", 3, "bad-index");
    expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", 3, "empty-mesh");
    expect_refused("a.obj", "v 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n", 3, "no triangle is left");
}

TEST_F(BadInput, MissingFilesAndFolders)
{
    expect_one_line_error(run({"encode", path("none.ply"), "-o", path("a.vsplit")}), 5);
    std::filesystem::create_directory(path("folder.ply"));
    expect_one_line_error(run({"encode", path("folder.ply"), "-o", path("a.vsplit")}), 5);
    save("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_one_line_error(run({"encode", path("a.obj"), "-o", path("no/a.vsplit"), "--quiet"}), 5);
    EXPECT_THAT(files(), ElementsAre("a.obj", "folder.ply"));
}

TEST_F(BadInput, NamesWithLineEndsStillGiveOneLine)
{
    expect_one_line_error(run({"encode", path("two\nlines.ply")}), 5);
}

TEST_F(BadInput, SmallestMeshesEncode)
{
    save("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    save("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 5 5\nv 5 6 5\nf 1 2 3\nf 4 5 6\n");
    save("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    save("huge.obj", "v 0 0 0\nv 1e38 0 0\nv 0 1e38 0\nf 1 2 3\n");
    save("tiny.obj", "v 0 0 0\nv 1e-38 0 0\nv 0 1e-38 0\nf 1 2 3\n");
    for (const std::string name : {"triangle", "two", "flat", "huge", "tiny"})
    {
        const Finished encoded = run({"encode", path(name + ".obj"), "--quiet"});
        EXPECT_EQ(encoded.status, 0) << name << ": " << encoded.err;
        const Finished verified =
            run({"verify", path(name + ".vsplit"), "--against", path(name + ".obj")});
        EXPECT_EQ(verified.status, 0) << name << ": " << verified.err;
    }
}

}  // namespace
}  // namespace vsplit::test
