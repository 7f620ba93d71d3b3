#include "precompute/mesh_files.h"

#include <gmock/gmock.h>

namespace vsplit::test {
namespace {

using precompute::read_mesh;
using precompute::write_mesh;

class MeshWriter : public MeshFiles
{
};

/// Positions that do not fit into few decimal digits.
IndexedMesh awkward_tetrahedron()
{
    IndexedMesh mesh = tetrahedron();
    mesh.positions[1] = {static_cast<double>(1.0F / 3.0F), 1e-30F, -123456.789F};
    mesh.positions[2] = {16777217.0F, 0.1F, 3.4e38F};
    return mesh;
}

TEST_F(MeshWriter, WritesEveryFormatSoThatFloatsComeBackExactly)
{
    const IndexedMesh mesh = awkward_tetrahedron();
    for (const std::string name : {"a.ply", "a.obj", "a.off", "A.PLY"})
    {
        ASSERT_TRUE(write_mesh(path(name), mesh));
        const auto back = read_mesh(path(name));
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->triangles, mesh.triangles);
        ASSERT_EQ(back->positions.size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                EXPECT_EQ(
                    static_cast<float>(back->positions[i][axis]),
                    static_cast<float>(mesh.positions[i][axis])
                );
            }
        }
    }
}

TEST_F(MeshWriter, WritesStlFacetsWithOutwardNormals)
{
    const IndexedMesh mesh = tetrahedron();
    ASSERT_TRUE(write_mesh(path("a.stl"), mesh));
    EXPECT_EQ(std::filesystem::file_size(path("a.stl")), 84U + 50U * 4U);
    const auto back = read_mesh(path("a.stl"));
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->triangles.size(), 4U);
    for (std::size_t face = 0; face < 4; ++face)
    {
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            EXPECT_EQ(
                back->positions[back->triangles[face][corner]],
                mesh.positions[mesh.triangles[face][corner]]
            );
        }
    }
    std::ifstream in(path("a.stl"), std::ios::binary);
    in.seekg(84);
    std::array<float, 3> normal{};
    in.read(reinterpret_cast<char*>(normal.data()), sizeof(normal));
    EXPECT_EQ(normal, (std::array{0.0F, 0.0F, -1.0F}));
}

TEST_F(MeshWriter, RefusesUnknownExtensionsAndMissingFolders)
{
    EXPECT_EQ(write_mesh(path("a.fbx"), tetrahedron()).error().code, ErrorCode::UnsupportedInput);
    EXPECT_EQ(write_mesh(path("no/a.ply"), tetrahedron()).error().code, ErrorCode::IoError);
    EXPECT_TRUE(std::filesystem::is_empty(path("")));
}

}  // namespace
}  // namespace vsplit::test
