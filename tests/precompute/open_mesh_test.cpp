// Compares our readers and writers with OpenMesh's on files that both understand.
#include "precompute/mesh_files.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>

namespace vsplit::test {
namespace {

using precompute::read_mesh;
using precompute::write_mesh;
using OpenMeshMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

/// Triangles as rows of nine floats, each rotated so that the smallest corner comes first; sorted.
using Soup = std::vector<std::array<std::array<float, 3>, 3>>;

Soup sorted(Soup soup)
{
    for (auto& triangle : soup)
    {
        std::rotate(
            triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end()
        );
    }
    std::sort(soup.begin(), soup.end());
    return soup;
}

Soup soup_of(const IndexedMesh& mesh)
{
    Soup soup;
    for (const Triangle& triangle : mesh.triangles)
    {
        auto& row = soup.emplace_back();
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                row[corner][axis] =
                    static_cast<float>(mesh.positions[triangle[corner]][axis]) + 0.0F;
            }
        }
    }
    return sorted(soup);
}

Soup soup_of(const OpenMeshMesh& mesh)
{
    Soup soup;
    for (const auto face : mesh.faces())
    {
        auto& row = soup.emplace_back();
        std::size_t corner = 0;
        for (const auto vertex : mesh.fv_range(face))
        {
            const auto point = mesh.point(vertex);
            row.at(corner++) = {point[0] + 0.0F, point[1] + 0.0F, point[2] + 0.0F};
        }
    }
    return sorted(soup);
}

class OpenMeshComparison : public MeshFiles
{
protected:
    void SetUp() override
    {
        MeshFiles::SetUp();
        omerr().disable();
    }
};

TEST_F(OpenMeshComparison, AgreesOnEveryDevelopmentMesh)
{
    if (model_files().empty())
    {
        GTEST_SKIP() << "no development meshes; set VSPLIT_MODELS";
    }
    for (const auto& file : model_files())
    {
        const auto ours = read_mesh(file);
        ASSERT_TRUE(ours) << ours.error().message;
        OpenMeshMesh theirs;
        ASSERT_TRUE(OpenMesh::IO::read_mesh(theirs, file.string()));
        // OpenMesh drops the few faces that its half-edge rules refuse (repeated vertices).
        Soup expected = soup_of(theirs);
        Soup found = soup_of(*ours);
        EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()))
            << file;
        EXPECT_LE(found.size() - expected.size(), 16U) << file;
    }
}

TEST_F(OpenMeshComparison, OpenMeshReadsWhatWeWrite)
{
    IndexedMesh mesh = tetrahedron();
    mesh.positions[3] = {static_cast<double>(1.0F / 3.0F), 2.5, -1e-7F};
    for (const std::string name : {"a.ply", "a.obj", "a.off", "a.stl"})
    {
        ASSERT_TRUE(write_mesh(path(name), mesh));
        OpenMeshMesh theirs;
        ASSERT_TRUE(OpenMesh::IO::read_mesh(theirs, path(name).string())) << name;
        EXPECT_EQ(theirs.n_vertices(), 4U) << name;
        EXPECT_EQ(soup_of(theirs), soup_of(mesh)) << name;
    }
}

TEST_F(OpenMeshComparison, AgreesOnWhatOpenMeshWrites)
{
    OpenMeshMesh theirs;
    std::vector<OpenMesh::VertexHandle> vertices;
    const IndexedMesh mesh = tetrahedron();
    for (const auto& [x, y, z] : mesh.positions)
    {
        vertices.push_back(theirs.add_vertex(OpenMesh::Vec3f(
            static_cast<float>(x), static_cast<float>(y), static_cast<float>(z / 3.0)
        )));
    }
    for (const auto& [a, b, c] : mesh.triangles)
    {
        theirs.add_face(vertices[a], vertices[b], vertices[c]);
    }
    const auto ascii = OpenMesh::IO::Options::Default;
    const OpenMesh::IO::Options little(OpenMesh::IO::Options::Binary | OpenMesh::IO::Options::LSB);
    const OpenMesh::IO::Options big(OpenMesh::IO::Options::Binary | OpenMesh::IO::Options::MSB);
    const std::vector<std::pair<std::string, OpenMesh::IO::Options>> files{
        {"a.ply", ascii},
        {"b.ply", little},
        {"c.ply", big},
        {"a.obj", ascii},
        {"a.off", ascii},
        {"a.stl", ascii},
        {"b.stl", little},
    };
    for (const auto& [name, options] : files)
    {
        ASSERT_TRUE(OpenMesh::IO::write_mesh(theirs, path(name).string(), options, 9)) << name;
        const auto ours = read_mesh(path(name));
        ASSERT_TRUE(ours) << name << ": " << ours.error().message;
        EXPECT_EQ(soup_of(*ours), soup_of(theirs)) << name;
    }
}

}  // namespace
}  // namespace vsplit::test
