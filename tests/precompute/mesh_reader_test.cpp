#include "precompute/mesh_files.h"

#include <gmock/gmock.h>

#include <cmath>

namespace vsplit::test {
namespace {

using precompute::read_mesh;
using ::testing::ElementsAre;

class MeshReader : public MeshFiles
{
};

using Point = std::array<double, 3>;

TEST_F(MeshReader, ReadsAsciiPlyInDoublePrecision)
{
    const auto mesh = read(
        "a.ply",
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 3\nproperty double x\n"
        "property double y\nproperty double z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "500000.0001 0 0\n1 +0.5 -1e-3\n0 1 0\n3 0 1 2\n"
    );
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_THAT(
        mesh->positions, ElementsAre(Point{500000.0001, 0, 0}, Point{1, 0.5, -1e-3}, Point{0, 1, 0})
    );
    EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST_F(MeshReader, SkipsPlyPropertiesAndElementsThatItDoesNotUse)
{
    const auto mesh = read(
        "a.ply",
        "ply\r\nformat ascii 1.0\r\nelement camera 2\r\nproperty list uchar float view\r\n"
        "property int id\r\nelement vertex 3\r\nproperty float nx\r\nproperty float y\r\n"
        "property list uchar int ring\r\nproperty float x\r\nproperty float z\r\n"
        "element face 1\r\nproperty list uchar float texcoord\r\n"
        "property list uchar int vertex_index\r\nproperty uchar red\r\nelement edge 1\r\n"
        "property int vertex1\r\nproperty int vertex2\r\nend_header\r\n"
        "2 0.5 0.5 7\r\n0 8\r\n"
        "nan 0 2 1 2 0 0\r\nnan 0 0 1 0\r\nnan 1 1 5 0 0\r\n"
        "2 0.1 0.2 3 2 1 0 255\r\n0 1\r\n"
    );
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_THAT(mesh->positions, ElementsAre(Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}));
    EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{2, 1, 0}));
}

/// A square as binary PLY with every kind of scalar in its rows.
std::string binary_square(bool big_endian)
{
    std::string file = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                       "_endian 1.0\nelement vertex 4\nproperty uchar red\nproperty float x\n"
                       "property short y\nproperty double z\nelement face 1\n"
                       "property uint16 flags\nproperty list ushort uint vertex_indices\n"
                       "property list int double uv\nend_header\n";
    for (const auto& [x, y] : {std::pair{0.1F, 0}, {1.0F, 0}, {1.0F, 1}, {0.1F, -1}})
    {
        append_value(file, std::uint8_t{200}, big_endian);
        append_value(file, x, big_endian);
        append_value(file, static_cast<std::int16_t>(y), big_endian);
        append_value(file, 0.1, big_endian);
    }
    append_value(file, std::uint16_t{1}, big_endian);
    append_value(file, std::uint16_t{4}, big_endian);
    for (const std::uint32_t index : {0U, 1U, 2U, 3U})
    {
        append_value(file, index, big_endian);
    }
    append_value(file, std::int32_t{1}, big_endian);
    append_value(file, 0.5, big_endian);
    return file;
}

TEST_F(MeshReader, ReadsBinaryPlyOfBothByteOrders)
{
    for (const bool big_endian : {false, true})
    {
        const auto mesh = read("a.ply", binary_square(big_endian));
        ASSERT_TRUE(mesh) << mesh.error().message;
        const double x = 0.1F;  // a float stays exactly that float
        EXPECT_THAT(
            mesh->positions,
            ElementsAre(Point{x, 0, 0.1}, Point{1, 0, 0.1}, Point{1, 1, 0.1}, Point{x, -1, 0.1})
        );
        EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    }
}

TEST_F(MeshReader, UnrollsPlyTriangleStrips)
{
    const auto mesh = read(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n"
        "10 0 1 2 3 -1 2 3 4 4 4\n"
    );
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_THAT(
        mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{2, 3, 4})
    );
}

TEST_F(MeshReader, ReadsOffWithCommentsColoursAndNormals)
{
    for (const std::string header :
         {"OFF\n# a comment\n\n4 2 0\n", "COFF 4 2 5\n", "STCNOFF\n4 2\n"})
    {
        const auto mesh = read(
            "a.off",
            header +
                "0 0 0 255 0 0\n1 0 0 # corner\n\n1 1 0\n0 1 0.1 0 0 1\n3 0 1 2 0.5 0.5 0.5\n"
                "3 0 2 3\n"
        );
        ASSERT_TRUE(mesh) << header << mesh.error().message;
        EXPECT_THAT(
            mesh->positions,
            ElementsAre(Point{0, 0, 0}, Point{1, 0, 0}, Point{1, 1, 0}, Point{0, 1, 0.1})
        );
        EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    }
}

TEST_F(MeshReader, ReadsObjWithNegativeIndicesContinuedLinesAndPolygons)
{
    const auto mesh = read(
        "a.OBJ",
        "# comment\nmtllib ../../dev/zero\no thing\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 \\\n0\n"
        "vt 0 0\nvn 0 0 1\nusemtl red\nf -3//1 -2//1 -1//1\nv 0 1 0\nv -1 0.5 0\ns off\nl 1 2\n"
        "f 1/1 2/1/1 3 4 5 # pentagon\n"
    );
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions.size(), 5U);
    EXPECT_THAT(
        mesh->triangles,
        ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4})
    );
}

TEST_F(MeshReader, KeepsPolygonsOfOneAndTwoCornersAsDegenerateTriangles)
{
    const auto mesh = read("a.off", "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n1 2\n");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_THAT(
        mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 1}, Triangle{2, 2, 2})
    );
}

TEST_F(MeshReader, ReadsAsciiStlOfAnyCase)
{
    const auto mesh = read(
        "a.stl",
        "solid vertex facet\n  FACET NORMAL 0 0 1\n    OUTER LOOP\n      VERTEX 0 0 0\n"
        "      VERTEX 1 0 0\n      VERTEX 0 1e0 0\n    ENDLOOP\n  ENDFACET\n"
        "facet normal nan nan nan\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid vertex facet\n"
    );
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 5}));
    EXPECT_EQ(mesh->positions[4], (Point{1, 1, 0}));
}

TEST_F(MeshReader, ReadsBinaryStlEvenWhenItStartsWithSolid)
{
    std::string file = "solid but binary";
    file.resize(80, ' ');
    append_value(file, std::uint32_t{1});
    for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 0.1F, 0.F})
    {
        append_value(file, value);
    }
    append_value(file, std::uint16_t{0});
    const auto mesh = read("a.stl", file);
    ASSERT_TRUE(mesh) << mesh.error().message;
    const double y = 0.1F;
    EXPECT_THAT(mesh->positions, ElementsAre(Point{0, 0, 0}, Point{1, 0, 0}, Point{0, y, 0}));
    EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST_F(MeshReader, ReadsEveryKindOfLineEndAndAByteOrderMark)
{
    for (const std::string end : {"\n", "\r\n", "\r"})
    {
        const std::string text =
            "\xEF\xBB\xBFv 0 0 0" + end + "v 1 0 0" + end + end + "v 0 1 0" + end + "f 1 2 3";
        for (const std::string& contents : {text, text + end})
        {
            const auto mesh = read("a.obj", contents);
            ASSERT_TRUE(mesh) << mesh.error().message;
            EXPECT_EQ(mesh->positions.size(), 3U);
            EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}));
        }
        const auto bad = read("a.obj", "v 0 0 0" + end + end + "v 1 0" + end + "f 1 1 1" + end);
        ASSERT_FALSE(bad);
        EXPECT_THAT(bad.error().message, ::testing::HasSubstr("line 3"));
    }
}

TEST_F(MeshReader, TakesNumbersTooSmallForADoubleAsZero)
{
    const auto mesh = read("a.obj", "v 1e-400 0 0\nv 1 0 0\nv 0 1 -2.5e-9999\nf 1 2 3\n");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions[0][0], 0.0);
    EXPECT_EQ(mesh->positions[2][2], 0.0);
}

}  // namespace
}  // namespace vsplit::test
