#include "paper/simplifiers.h"

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <stdexcept>
#include <vector>

namespace vsplit::bench {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits
{
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};

using TriMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using Decimater = OpenMesh::Decimater::DecimaterT<TriMesh>;
using Quadrics = OpenMesh::Decimater::ModQuadricT<TriMesh>;

}  // namespace

IndexedMesh simplify_by_open_mesh(const IndexedMesh& mesh, std::size_t faces)
{
    TriMesh linked;
    std::vector<TriMesh::VertexHandle> handles;
    for (const auto& [x, y, z] : mesh.positions)
    {
        handles.push_back(linked.add_vertex({x, y, z}));
    }
    for (const auto& [a, b, c] : mesh.triangles)
    {
        linked.add_face(handles[a], handles[b], handles[c]);
    }
    linked.request_face_normals();
    linked.update_face_normals();
    Decimater decimater(linked);
    Quadrics::Handle quadrics;
    decimater.add(quadrics);
    decimater.module(quadrics).unset_max_err();
    if (!decimater.initialize())
    {
        throw std::runtime_error("OpenMesh's decimater does not start");
    }
    decimater.decimate_to_faces(0, faces);
    linked.garbage_collection();

    IndexedMesh result;
    for (const auto vertex : linked.vertices())
    {
        const auto& point = linked.point(vertex);
        result.positions.push_back({point[0], point[1], point[2]});
    }
    for (const auto face : linked.faces())
    {
        Triangle triangle{};
        std::size_t corner = 0;
        for (const auto vertex : linked.fv_range(face))
        {
            triangle[corner++] = static_cast<std::uint32_t>(vertex.idx());
        }
        result.triangles.push_back(triangle);
    }
    return without_unused_vertices(result);
}

}  // namespace vsplit::bench
