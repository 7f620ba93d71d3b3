#include "precompute/half_edge_mesh.h"
#include "precompute/mesh_files.h"
#include "precompute/mesh_readers.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <OpenMesh/Core/Utils/PropertyManager.hh>
#include <gmock/gmock.h>

#include <limits>
#include <random>
#include <span>

namespace vsplit::test {
namespace {

using precompute::HalfEdgeMesh;
using precompute::read_mesh;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;
using Options = OpenMesh::IO::Options;

/// Two quadrilaterals and a pentagon in a row.
PolyMesh polygons()
{
    PolyMesh mesh;
    std::vector<OpenMesh::VertexHandle> v;
    for (int i = 0; i < 9; ++i)
    {
        v.push_back(mesh.add_vertex({static_cast<float>(i / 2), static_cast<float>(i % 2), 0.1F}));
    }
    mesh.add_face({v[0], v[2], v[3], v[1]});
    mesh.add_face({v[2], v[4], v[5], v[3]});
    mesh.add_face({v[4], v[6], v[8], v[7], v[5]});
    return mesh;
}

class OmReader : public MeshFiles
{
protected:
    static Result<IndexedMesh> parse(const std::string& bytes)
    {
        return precompute::read_om(std::as_bytes(std::span(bytes)));
    }

    /// Writes a mesh through OpenMesh and returns the bytes of the file.
    template <typename Mesh>
    [[nodiscard]] std::string written(const Mesh& mesh, Options options = Options::Default) const
    {
        omlog().disable();  // OpenMesh enables it again with every file
        EXPECT_TRUE(OpenMesh::IO::write_mesh(mesh, path("written.om").string(), options));
        std::ifstream in(path("written.om"), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    static void expect_refused(
        const std::string& bytes, std::string_view words, ErrorCode code = ErrorCode::NotAMesh
    )
    {
        const auto mesh = parse(bytes);
        ASSERT_FALSE(mesh);
        EXPECT_EQ(mesh.error().code, code) << mesh.error().message;
        EXPECT_THAT(mesh.error().message, HasSubstr(std::string(words)));
    }
};

/// Places in the file that OpenMesh writes for tetrahedron(): header, chunk header, 4 x 3 doubles,
/// chunk header, then for each of 12 half-edges next, end and face in a byte each.
constexpr std::size_t kHalfEdges = 16 + 2 + 4 * 24 + 2;

TEST_F(OmReader, ReadsAMeshInDoublePrecisionExactly)
{
    IndexedMesh mesh = tetrahedron();
    mesh.positions[2] = {0.1, 1.0 / 3.0, -1e-17};
    const auto linked = precompute::make_half_edge_mesh(mesh);
    ASSERT_TRUE(linked);
    const auto back = parse(written(*linked));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->positions, mesh.positions);
    EXPECT_EQ(back->triangles, mesh.triangles);
}

TEST_F(OmReader, ReadsAnAsset)
{
    const auto mesh = read_mesh(VSPLIT_SOURCE_DIR "/assets/terrain.ply");
    ASSERT_TRUE(mesh) << mesh.error().message;
    const auto back = read("a.OM", written(precompute::make_half_edge_mesh(*mesh).value()));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->positions, mesh->positions);
    EXPECT_EQ(back->triangles, mesh->triangles);
}

TEST_F(OmReader, ReadsPolygonsAndSkipsWhatIsNoGeometry)
{
    PolyMesh mesh = polygons();
    mesh.request_vertex_normals();
    mesh.request_vertex_colors();
    mesh.request_vertex_texcoords2D();
    mesh.request_face_normals();
    mesh.request_face_colors();
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    auto names = OpenMesh::VProp<std::string>(mesh, "names");
    auto lists = OpenMesh::FProp<std::vector<double>>(mesh, "lists");
    mesh.property(names.getRawProperty(), OpenMesh::VertexHandle(3)) = "a long name";
    mesh.property(lists.getRawProperty(), OpenMesh::FaceHandle(1)) = {1.0, 2.0};
    mesh.property(names.getRawProperty()).set_persistent(true);
    mesh.property(lists.getRawProperty()).set_persistent(true);
    Options options(Options::VertexNormal);
    for (const auto more :
         {Options::VertexColor,
          Options::VertexTexCoord,
          Options::FaceNormal,
          Options::FaceColor,
          Options::Status})
    {
        options += more;
    }
    const std::string bytes = written(mesh, options);
    ASSERT_THAT(bytes, HasSubstr("a long name"));
    const auto back = parse(bytes);
    ASSERT_TRUE(back) << back.error().message;
    const auto plain = parse(written(polygons()));
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_EQ(back->positions.size(), 9U);
    EXPECT_EQ(back->positions[3][2], static_cast<double>(0.1F));
    EXPECT_EQ(back->triangles.size(), 2U + 2U + 3U);
    EXPECT_EQ(back->positions, plain->positions);
    EXPECT_EQ(back->triangles, plain->triangles);
}

TEST_F(OmReader, LeavesOutFacesThatWereDeleted)
{
    PolyMesh mesh = polygons();
    mesh.request_face_status();
    mesh.request_edge_status();
    mesh.request_vertex_status();
    mesh.delete_face(OpenMesh::FaceHandle(1), false);
    const auto back = parse(written(mesh));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->triangles.size(), 2U + 3U);
}

/// A file of version 1.2: positions as floats and faces by their vertices.
std::string version_one(char kind, const std::vector<std::vector<std::uint8_t>>& faces)
{
    std::string bytes{'O', 'M', kind, '\x22'};
    append_value(bytes, std::uint32_t{4});
    append_value(bytes, static_cast<std::uint32_t>(faces.size()));
    append_value(bytes, std::uint32_t{0});
    append_value(bytes, std::uint16_t{0x1600});  // vertex positions, three signed floats
    for (int i = 0; i < 12; ++i)
    {
        append_value(bytes, 0.5F * static_cast<float>(i * i));
    }
    append_value(bytes, std::uint16_t{0x0008 | 0x00E0});  // face topology, bytes
    for (const auto& face : faces)
    {
        if (kind == 'P')
        {
            append_value(bytes, static_cast<std::uint16_t>(face.size()));
        }
        bytes.append(face.begin(), face.end());
    }
    return bytes;
}

TEST_F(OmReader, ReadsVersionOne)
{
    const auto triangles = parse(version_one('T', {{0, 1, 2}, {2, 1, 3}}));
    ASSERT_TRUE(triangles) << triangles.error().message;
    EXPECT_THAT(triangles->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
    EXPECT_EQ(triangles->positions[3], (std::array{40.5, 50.0, 60.5}));
    const auto quads = parse(version_one('Q', {{0, 1, 2, 3}}));
    ASSERT_TRUE(quads) << quads.error().message;
    EXPECT_THAT(quads->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    const auto mixed = parse(version_one('P', {{3, 1, 0}, {}, {0, 1, 2, 3}}));
    ASSERT_TRUE(mixed) << mixed.error().message;
    EXPECT_EQ(mixed->triangles.size(), 3U);
    expect_refused(version_one('T', {{0, 1, 4}}), "vertex 4", ErrorCode::BadIndex);
}

TEST_F(OmReader, RefusesEveryTruncation)
{
    const std::string whole = written(polygons());
    const std::size_t sentinel = 2;  // the mesh is complete without it
    for (std::size_t length = 0; length < whole.size() - sentinel; ++length)
    {
        ASSERT_FALSE(parse(whole.substr(0, length))) << length << " of " << whole.size();
    }
    EXPECT_TRUE(parse(whole.substr(0, whole.size() - sentinel)));
    for (const char kind : {'T', 'Q', 'P'})
    {
        const std::string old = version_one(kind, {{0, 1, 2, 3}});
        ASSERT_FALSE(parse(old.substr(0, old.size() - 2))) << kind;
    }
}

TEST_F(OmReader, RefusesHeadersThatPromiseTooMuch)
{
    const std::string whole = written(polygons());
    for (const std::size_t count : {4U, 8U, 12U})
    {
        std::string bytes = whole;
        bytes.replace(count, 4, std::string("\xFF\xFF\xFF\x7F", 4));
        expect_refused(bytes, "more than a mesh can have", ErrorCode::InputTooLarge);
        bytes.replace(count, 4, std::string("\xFF\xFF\xFF\x00", 4));
        expect_refused(bytes, "ends too early");
    }
    std::string bytes = whole;
    bytes[3] = '\x43';
    expect_refused(bytes, "version 2.3", ErrorCode::UnsupportedInput);
    bytes[2] = 'X';
    expect_refused(bytes, "does not start");
}

TEST_F(OmReader, RefusesChunksAtWhichOpenMeshAbortsOrThrows)
{
    const std::string whole = written(precompute::make_half_edge_mesh(tetrahedron()).value());
    std::string bytes = whole;
    bytes[17] = static_cast<char>(bytes[17] & ~0x38);  // positions of one dimension
    expect_refused(bytes, "not three floating-point numbers");
    bytes = version_one('P', {{}});
    bytes[16 + 2 + 48 + 1] = '\xC0';
    expect_refused(bytes, "integers of 64 bits");
    bytes = whole;
    bytes[16] = static_cast<char>(bytes[16] | (5 << 5));  // positions become an unknown type
    expect_refused(bytes, "unknown type");
    const std::string positions = whole.substr(16, 2 + 4 * 24);
    expect_refused(whole.substr(0, 16) + positions + whole.substr(16), "same chunk twice");
}

TEST_F(OmReader, RefusesHalfEdgesThatAreNoLoops)
{
    const std::string whole = written(precompute::make_half_edge_mesh(tetrahedron()).value());
    ASSERT_EQ(parse(whole)->triangles, tetrahedron().triangles);
    for (std::size_t half = 0; half < 12; ++half)
    {
        for (const char value : {'\x7F', '\x80', '\xFF', '\x0C', static_cast<char>(half)})
        {
            std::string bytes = whole;
            bytes[kHalfEdges + 3 * half] = value;
            expect_refused(bytes, "no loop");
            bytes = whole;
            bytes[kHalfEdges + 3 * half + 1] = static_cast<char>(value | '\x40');
            expect_refused(bytes, "refers to vertex", ErrorCode::BadIndex);
        }
    }
}

TEST_F(OmReader, RefusesCoordinatesThatAreNotFinite)
{
    HalfEdgeMesh mesh = precompute::make_half_edge_mesh(tetrahedron()).value();
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), 1e39})
    {
        mesh.point(OpenMesh::VertexHandle(1))[2] = value;
        expect_refused(written(mesh), "vertex 1 ", ErrorCode::BadCoordinate);
    }
}

TEST_F(OmReader, SurvivesDamage)
{
    PolyMesh mesh = polygons();
    mesh.request_vertex_normals();
    auto lists = OpenMesh::VProp<std::vector<double>>(mesh, "lists");
    mesh.property(lists.getRawProperty()).set_persistent(true);
    const std::string files[] = {
        written(mesh, Options::VertexNormal), version_one('P', {{3, 1, 0}, {0, 1, 2, 3}})};
    std::mt19937 random(7);
    int read_anyway = 0;
    for (int round = 0; round < 20000; ++round)
    {
        std::string damaged = files[round % 2];
        for (int change = 0; change < 2; ++change)
        {
            damaged[random() % damaged.size()] = static_cast<char>(random() & 0xFFU);
        }
        const auto result = parse(damaged);
        read_anyway += result ? 1 : 0;
        if (!result)
        {
            ASSERT_EQ(exit_status(result.error().code), 3) << result.error().message;
        }
    }
    EXPECT_GT(read_anyway, 0);
}

}  // namespace
}  // namespace vsplit::test
