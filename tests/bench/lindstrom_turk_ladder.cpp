#include "lod_ladder.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <array>

namespace vsplit::bench {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

IndexedMesh snapshot(const SurfaceMesh& surface)
{
    std::vector<std::uint32_t> place(
        surface.number_of_vertices() + surface.number_of_removed_vertices()
    );
    IndexedMesh mesh;
    for (const auto vertex : surface.vertices())
    {
        const Point& point = surface.point(vertex);
        place[vertex.idx()] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back({point.x(), point.y(), point.z()});
    }
    for (const auto face : surface.faces())
    {
        Triangle triangle{};
        std::size_t corner = 0;
        for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
        {
            triangle[corner++] = place[vertex.idx()];
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// Stops never; asked before every collapse, it copies the mesh whenever a level is reached.
class SnapshotTaker
{
public:
    SnapshotTaker(const std::vector<std::size_t>& targets, std::vector<IndexedMesh>& levels)
        : targets_(&targets), levels_(&levels)
    {
    }

    template <typename Cost, typename Profile, typename Size>
    bool operator()(const Cost&, const Profile& profile, Size, Size) const
    {
        const SurfaceMesh& surface = profile.surface_mesh();
        while (levels_->size() < targets_->size() &&
               surface.number_of_faces() <= (*targets_)[levels_->size()])
        {
            levels_->push_back(snapshot(surface));
        }
        return levels_->size() == targets_->size();
    }

private:
    const std::vector<std::size_t>* targets_;
    std::vector<IndexedMesh>* levels_;
};

class LindstromTurkLadder : public LodLadder
{
public:
    LindstromTurkLadder(const IndexedMesh& mesh, double ratio)
    {
        SurfaceMesh surface;
        for (const auto& position : mesh.positions)
        {
            surface.add_vertex(Point(position[0], position[1], position[2]));
        }
        for (const Triangle& triangle : mesh.triangles)
        {
            surface.add_face(
                SurfaceMesh::Vertex_index(triangle[0]),
                SurfaceMesh::Vertex_index(triangle[1]),
                SurfaceMesh::Vertex_index(triangle[2])
            );
        }
        levels_.push_back(mesh);
        const auto targets = ladder_targets(mesh.triangles.size(), ratio);
        CGAL::Surface_mesh_simplification::edge_collapse(surface, SnapshotTaker(targets, levels_));
    }

    std::size_t size() const override { return levels_.size(); }

    const IndexedMesh& level(std::size_t index) override { return levels_[index]; }

private:
    std::vector<IndexedMesh> levels_;
};

}  // namespace

std::unique_ptr<LodLadder> make_lindstrom_turk_ladder(const IndexedMesh& mesh, double ratio)
{
    return std::make_unique<LindstromTurkLadder>(mesh, ratio);
}

}  // namespace vsplit::bench
