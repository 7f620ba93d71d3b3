#include "precompute/mesh_files.h"

#include <gmock/gmock.h>

#include <random>

namespace vsplit::test {
namespace {

using precompute::read_mesh;
using ::testing::HasSubstr;
using ::testing::Not;

class HostileMesh : public MeshFiles
{
protected:
    /// Reads a file that must be refused, and checks the code and that the message is one line.
    void expect_refused(
        std::string_view name,
        std::string_view contents,
        ErrorCode code,
        std::string_view words = "cannot read "
    ) const
    {
        const auto mesh = read(name, contents);
        ASSERT_FALSE(mesh) << name << " was read: " << contents.substr(0, 200);
        EXPECT_EQ(mesh.error().code, code) << mesh.error().message;
        EXPECT_THAT(mesh.error().message, HasSubstr(std::string(words)));
        EXPECT_THAT(mesh.error().message, Not(HasSubstr("\n")));
    }
};

constexpr std::string_view kPlyRows =
    "property float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string ply(std::string_view format, std::string_view vertex_count)
{
    return "ply\nformat " + std::string(format) + " 1.0\nelement vertex " +
           std::string(vertex_count) + "\n" + std::string(kPlyRows);
}

TEST_F(HostileMesh, RefusesMissingFilesFoldersAndUnknownExtensions)
{
    EXPECT_EQ(read_mesh(path("none.ply")).error().code, ErrorCode::NotFound);
    std::filesystem::create_directory(path("folder.ply"));
    EXPECT_EQ(read_mesh(path("folder.ply")).error().code, ErrorCode::IoError);
    expect_refused("a.txt", "hello", ErrorCode::UnsupportedInput, "none of .obj, .ply");
    expect_refused("noextension", "hello", ErrorCode::UnsupportedInput);
}

TEST_F(HostileMesh, RefusesEmptyFilesAndNoiseOfEveryFormat)
{
    std::mt19937 random(20);
    std::string noise(20000, '\0');
    for (char& byte : noise)
    {
        byte = static_cast<char>(random() & 0xFFU);
    }
    for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl", "a.om"})
    {
        expect_refused(name, "", ErrorCode::NotAMesh, "the file is empty");
        expect_refused(name, noise, ErrorCode::NotAMesh);
        expect_refused(name, "\n\n \n", ErrorCode::NotAMesh);
        expect_refused(name, "This is a letter, not a mesh.\n", ErrorCode::NotAMesh);
    }
}

TEST_F(HostileMesh, RefusesCountsThatTheFileCannotHold)
{
    for (const std::string_view format : {"ascii", "binary_little_endian", "binary_big_endian"})
    {
        expect_refused(
            "a.ply",
            ply(format, "2000000000") + std::string(1000, '0'),
            ErrorCode::NotAMesh,
            "the header claims 2000000000 vertices but the file has 1 kB"
        );
        expect_refused("a.ply", ply(format, "9223372036854775807"), ErrorCode::NotAMesh);
        expect_refused("a.ply", ply(format, "-1"), ErrorCode::NotAMesh);
        expect_refused("a.ply", ply(format, "99999999999999999999"), ErrorCode::NotAMesh);
    }
    expect_refused(
        "a.off", "OFF\n2000000000 1 0\n0 0 0\n", ErrorCode::NotAMesh, "2000000000 vertices"
    );
    expect_refused(
        "a.off", "OFF\n1 2000000000 0\n0 0 0\n", ErrorCode::NotAMesh, "2000000000 faces"
    );
    std::string stl(84, '\0');
    stl.replace(80, 4, "\xff\xff\xff\xff");
    expect_refused("a.stl", stl, ErrorCode::NotAMesh, "4294967295 triangles");
}

TEST_F(HostileMesh, RefusesListLengthsThatTheFileCannotHold)
{
    std::string file =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\n"
        "property list uint int vertex_indices\nend_header\n";
    file.append(12, '\0');
    append_value(file, std::uint32_t{4000000000});
    file.append(400, '\0');
    expect_refused("a.ply", file, ErrorCode::NotAMesh);
    expect_refused("a.off", "OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n", ErrorCode::NotAMesh, "line 4");
    expect_refused("a.ply", ply("ascii", "1") + "0 0 0\n4000000000 0 0 0\n", ErrorCode::NotAMesh);
}

TEST_F(HostileMesh, RefusesEveryTruncationOfEveryFormat)
{
    const IndexedMesh mesh = tetrahedron();
    for (const std::string name : {"whole.ply", "whole.stl", "whole.off"})
    {
        ASSERT_TRUE(precompute::write_mesh(path(name), mesh));
        std::ifstream in(path(name), std::ios::binary);
        const std::string whole((std::istreambuf_iterator<char>(in)), {});
        // A text without its last line end, or without the last digit's follower, is complete.
        const std::size_t longest = whole.size() - (name == "whole.off" ? 2 : 0);
        for (std::size_t length = 0; length < longest; ++length)
        {
            EXPECT_FALSE(read("cut" + name.substr(5), whole.substr(0, length)))
                << name << " cut to " << length << " of " << whole.size();
        }
    }
    const std::string ascii =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid";
    for (std::size_t length = 0; length < ascii.size(); ++length)
    {
        EXPECT_FALSE(read("cut.stl", ascii.substr(0, length))) << length;
    }
    EXPECT_TRUE(read("cut.stl", ascii));
}

TEST_F(HostileMesh, RefusesCoordinatesThatAreNotFinite)
{
    for (const std::string value : {"nan", "NaN", "inf", "-inf", "1e999", "1e39"})
    {
        const auto code = ErrorCode::BadCoordinate;
        expect_refused(
            "a.obj", "v 0 0 0\nv 1 0 " + value + "\nv 0 1 0\nf 1 2 3\n", code, "vertex 1"
        );
        expect_refused("a.off", "OFF\n3 1 0\n0 0 0\n0 1 " + value + "\n0 1 0\n3 0 1 2\n", code);
        expect_refused(
            "a.ply", ply("ascii", "3") + "0 0 0\n0 1 " + value + "\n0 1 0\n3 0 1 2\n", code
        );
        expect_refused(
            "a.stl",
            "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 " + value +
                " 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n",
            code
        );
    }
}

TEST_F(HostileMesh, RefusesIndicesOutOfRange)
{
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const std::string face : {"1 2 4", "0 1 2", "1 2 -4", "1 2 4294967297", "1 2 268435457"})
    {
        expect_refused("a.obj", points + "f " + face + "\n", ErrorCode::BadIndex);
    }
    for (const std::string face : {"3 0 1 3", "3 0 1 -1", "3 0 1 99999999999"})
    {
        expect_refused(
            "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + face + "\n", ErrorCode::BadIndex
        );
        expect_refused(
            "a.ply", ply("ascii", "3") + "0 0 0\n1 0 0\n0 1 0\n" + face + "\n", ErrorCode::BadIndex
        );
    }
}

TEST_F(HostileMesh, RefusesBrokenHeadersAndLines)
{
    const auto code = ErrorCode::NotAMesh;
    expect_refused("a.ply", "ply\nelement vertex 1\nend_header\n", code, "names no format");
    expect_refused("a.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", code);
    expect_refused("a.ply", "ply\nformat ebcdic 1.0\nend_header\n", code);
    expect_refused(
        "a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int a\n", code
    );
    expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n", code);
    expect_refused(
        "a.ply", "ply\nformat ascii 1.0\nelement ghost 9000000000000\nend_header\n", code
    );
    expect_refused(
        "a.ply", ply("ascii", "3") + "0 0 0\n1 0 0\n0 1 zero\n3 0 1 2\n", code, "do not match"
    );
    expect_refused("a.ply", ply("ascii", "3") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n", code);
    expect_refused("a.ply", ply("ascii", "3") + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", code);
    expect_refused("a.off", "OFF\n3 -1 0\n", code);
    expect_refused("a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", code, "line 4");
    expect_refused("a.obj", "v 0 0 0\nv 1 0\nf 1 2 1\n", code, "line 2");
    expect_refused("a.obj", "v 0 0 0\nf one two three\n", code, "line 2");
    expect_refused("a.obj", "v 0 0 0\nf\n", code, "line 2");
    expect_refused("a.stl", "solid\nvertex 0 0 0\nendsolid\n", code, "line 2");
    expect_refused("a.off", "OFF BINARY\n", ErrorCode::UnsupportedInput, "binary OFF");
    expect_refused("a.off", "4OFF\n1 1 1\n", ErrorCode::UnsupportedInput, "dimensions");
}

TEST_F(HostileMesh, CallsPointCloudsEmptyMeshes)
{
    expect_refused("a.obj", "v 0 0 0\nv 1 0 0\n", ErrorCode::EmptyMesh, "no face");
    expect_refused("a.off", "OFF\n1 0 0\n0 0 0\n", ErrorCode::EmptyMesh);
    expect_refused(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n0 0 0\n",
        ErrorCode::EmptyMesh
    );
}

TEST_F(HostileMesh, SurvivesDamagedFilesOfEveryFormat)
{
    std::mt19937 random(7);
    for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl"})
    {
        ASSERT_TRUE(precompute::write_mesh(path(name), tetrahedron()));
        std::ifstream in(path(name), std::ios::binary);
        const std::string whole((std::istreambuf_iterator<char>(in)), {});
        for (int round = 0; round < 400; ++round)
        {
            std::string damaged = whole;
            for (int change = 0; change < 3; ++change)
            {
                damaged[random() % damaged.size()] = static_cast<char>(random() & 0xFFU);
            }
            const auto mesh = read("damaged" + name.substr(1), damaged);
            if (mesh)
            {
                EXPECT_FALSE(mesh->triangles.empty());
            }
            else
            {
                EXPECT_EQ(exit_status(mesh.error().code), 3) << mesh.error().message;
            }
        }
    }
}

}  // namespace
}  // namespace vsplit::test
