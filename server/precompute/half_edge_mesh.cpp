// Based on: Botsch, Steinberg, Bischoff, Kobbelt, "OpenMesh - a generic and efficient polygon mesh data
// structure", 2002.
// Departure: edges come from a sorted table and are linked through OpenMesh's kernel instead of its
// add_face(), which searches the ring of a vertex for every face: a hub of 50000 triangles in random
// order took 13.9 seconds with it and takes 0.015.
#include "precompute/half_edge_mesh.h"

#include "precompute/edge_table.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace vsplit::precompute {
namespace {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Every triangle has at most three edges of its own, and handles are signed.
constexpr std::size_t kMostTriangles = (std::size_t{1} << 30) / 3;

tl::unexpected<Error> not_manifold(const std::string& what)
{
    return fail(ErrorCode::UnsupportedInput, "the mesh is not an oriented manifold: " + what);
}

tl::unexpected<Error> several_fans(VertexHandle vertex)
{
    return not_manifold("vertex " + std::to_string(vertex.idx()) + " has several fans of faces");
}

Result<void> check_triangles(const IndexedMesh& mesh)
{
    if (mesh.triangles.empty())
    {
        return fail(ErrorCode::EmptyMesh, "the mesh has no triangle");
    }
    if (mesh.triangles.size() > kMostTriangles)
    {
        return fail(ErrorCode::InputTooLarge, "the mesh has too many triangles");
    }
    const std::size_t count = mesh.positions.size();
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
    {
        const auto [a, b, c] = mesh.triangles[face];
        if (a >= count || b >= count || c >= count)
        {
            return fail(
                ErrorCode::BadIndex,
                "face " + std::to_string(face) + " refers to a vertex that does not exist"
            );
        }
        if (a == b || b == c || c == a)
        {
            return not_manifold("face " + std::to_string(face) + " repeats a vertex");
        }
    }
    return {};
}

/// Fills a HalfEdgeMesh; what is not a manifold is found before a circulator could go astray on it.
class Linker
{
public:
    Linker(const IndexedMesh& source, HalfEdgeMesh& mesh) : source_(source), mesh_(mesh) {}

    Result<void> run()
    {
        VSPLIT_TRY(check_triangles(source_));
        handles_.resize(3 * source_.triangles.size());
        VSPLIT_TRY(add_edges());
        add_faces();
        VSPLIT_TRY(link_boundaries());
        return check_fans();
    }

private:
    Result<void> add_edges()
    {
        const EdgeTable edges(source_.triangles, source_.positions.size());
        std::size_t edge_count = 0;
        edges.for_each_edge([&](std::span<const HalfEdge>) { ++edge_count; });
        mesh_.reserve(source_.positions.size(), edge_count, source_.triangles.size());
        for (const auto& [x, y, z] : source_.positions)
        {
            mesh_.add_vertex({x, y, z});
        }
        Result<void> result;
        edges.for_each_edge([&](std::span<const HalfEdge> halves) {
            if (result)
            {
                result = add_edge(halves);
            }
        });
        return result;
    }

    Result<void> add_edge(std::span<const HalfEdge> halves)
    {
        const HalfEdge first = halves.front();
        if (halves.size() > 2 || (halves.size() == 2 && start_of(first) == start_of(halves[1])))
        {
            return not_manifold(
                "face " + std::to_string(first / 3) + " has an edge with " +
                (halves.size() > 2 ? std::to_string(halves.size()) + " faces"
                                   : "a face of the opposite direction")
            );
        }
        handles_[first] = mesh_.new_edge(
            vertex_handle(start_of(first)), vertex_handle(start_of(next_in_face(first)))
        );
        if (halves.size() == 2)
        {
            handles_[halves[1]] = mesh_.opposite_halfedge_handle(handles_[first]);
        }
        return {};
    }

    void add_faces()
    {
        for (HalfEdge corner = 0; corner < handles_.size(); corner += 3)
        {
            const auto face = mesh_.new_face();
            // A face's vertices begin where its half-edge ends, see make_half_edge_mesh().
            mesh_.set_halfedge_handle(face, handles_[corner + 2]);
            for (HalfEdge half = corner; half < corner + 3; ++half)
            {
                mesh_.set_face_handle(handles_[half], face);
                mesh_.set_next_halfedge_handle(handles_[half], handles_[next_in_face(half)]);
                mesh_.set_halfedge_handle(vertex_handle(start_of(half)), handles_[half]);
            }
        }
    }

    /// Every boundary vertex has one half-edge without a face that leaves it, else it is several fans.
    Result<void> link_boundaries()
    {
        std::vector<HalfedgeHandle> boundary;
        for (const HalfedgeHandle half : mesh_.halfedges())
        {
            if (!mesh_.is_boundary(half))
            {
                continue;
            }
            const VertexHandle start = mesh_.from_vertex_handle(half);
            if (mesh_.is_boundary(start))
            {
                return several_fans(start);
            }
            mesh_.set_halfedge_handle(start, half);
            boundary.push_back(half);
        }
        for (const HalfedgeHandle half : boundary)
        {
            mesh_.set_next_halfedge_handle(
                half, mesh_.halfedge_handle(mesh_.to_vertex_handle(half))
            );
        }
        return {};
    }

    /// Circulating round a vertex reaches one fan; the vertex is fine when that is all there is.
    [[nodiscard]] Result<void> check_fans() const
    {
        std::vector<std::uint32_t> valence(mesh_.n_vertices(), 0);
        for (const HalfedgeHandle half : mesh_.halfedges())
        {
            ++valence[static_cast<std::size_t>(mesh_.to_vertex_handle(half).idx())];
        }
        for (const VertexHandle vertex : mesh_.vertices())
        {
            if (mesh_.is_isolated(vertex))
            {
                return not_manifold("no face uses vertex " + std::to_string(vertex.idx()));
            }
            if (mesh_.valence(vertex) != valence[static_cast<std::size_t>(vertex.idx())])
            {
                return several_fans(vertex);
            }
        }
        return {};
    }

    [[nodiscard]] std::uint32_t start_of(HalfEdge half) const
    {
        return source_.triangles[half / 3][half % 3];
    }

    const IndexedMesh& source_;
    HalfEdgeMesh& mesh_;
    std::vector<HalfedgeHandle> handles_;  ///< By corner: the half-edge to the next corner.
};

}  // namespace

Result<HalfEdgeMesh> make_half_edge_mesh(const IndexedMesh& mesh)
{
    Result<HalfEdgeMesh> result;  // filled in place, for OpenMesh's meshes can only be copied
    if (const auto linked = Linker(mesh, *result).run(); !linked)
    {
        result = tl::unexpected<Error>(linked.error());
    }
    return result;
}

std::uint32_t component_count(const HalfEdgeMesh& mesh)
{
    std::vector<std::uint8_t> reached(mesh.n_vertices(), 0);
    std::vector<VertexHandle> open;
    const auto reach = [&](VertexHandle vertex) {
        std::uint8_t& state = reached[static_cast<std::size_t>(vertex.idx())];
        if (state == 0)
        {
            state = 1;
            open.push_back(vertex);
        }
    };
    std::uint32_t count = 0;
    for (const VertexHandle seed : mesh.vertices())
    {
        reach(seed);
        count += open.empty() ? 0 : 1;
        while (!open.empty())
        {
            const VertexHandle vertex = open.back();
            open.pop_back();
            for (const VertexHandle neighbour : mesh.vv_range(vertex))
            {
                reach(neighbour);
            }
        }
    }
    return count;
}

std::uint32_t boundary_edge_count(const HalfEdgeMesh& mesh)
{
    const auto edges = mesh.edges();
    return static_cast<std::uint32_t>(std::count_if(edges.begin(), edges.end(), [&](auto edge) {
        return mesh.is_boundary(edge);
    }));
}

}  // namespace vsplit::precompute
