#include "paper/lindstrom_turk.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::bench {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

/// Asked before every collapse: ends when few enough faces are left.
class EnoughFaces
{
public:
    explicit EnoughFaces(std::size_t faces) : faces_(faces) {}

    template <typename Cost, typename Profile, typename Size>
    bool operator()(const Cost&, const Profile& profile, Size, Size) const
    {
        return profile.surface_mesh().number_of_faces() <= faces_;
    }

private:
    std::size_t faces_;
};

}  // namespace

IndexedMesh simplify_by_lindstrom_turk(const IndexedMesh& mesh, std::size_t faces)
{
    SurfaceMesh surface;
    std::vector<SurfaceMesh::Vertex_index> vertices;
    for (const auto& [x, y, z] : mesh.positions)
    {
        vertices.push_back(surface.add_vertex(Point(x, y, z)));
    }
    for (const auto& [a, b, c] : mesh.triangles)
    {
        surface.add_face(vertices[a], vertices[b], vertices[c]);
    }
    CGAL::Surface_mesh_simplification::edge_collapse(surface, EnoughFaces(faces));
    surface.collect_garbage();

    IndexedMesh result;
    for (const auto vertex : surface.vertices())
    {
        const Point& point = surface.point(vertex);
        result.positions.push_back({point.x(), point.y(), point.z()});
    }
    for (const auto face : surface.faces())
    {
        Triangle triangle{};
        std::size_t corner = 0;
        for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
        {
            triangle[corner++] = static_cast<std::uint32_t>(vertex.idx());
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

}  // namespace vsplit::bench
