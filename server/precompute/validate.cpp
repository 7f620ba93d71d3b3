#include "precompute/validate.h"

#include "precompute/edge_table.h"

#include <string>

namespace vsplit::precompute {
namespace {

tl::unexpected<Error> not_manifold(const std::string& what)
{
    return fail(ErrorCode::UnsupportedInput, "the mesh is not an oriented manifold: " + what);
}

Result<void> check_triangles(const IndexedMesh& mesh)
{
    if (mesh.triangles.empty())
    {
        return fail(ErrorCode::EmptyMesh, "the mesh has no triangle");
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

/// Links the faces across every edge; fails at the first edge that is not shared properly.
Result<void> link_edges(const IndexedMesh& mesh, CornerFans& fans)
{
    const EdgeTable edges(mesh.triangles, mesh.positions.size());
    Result<void> result;
    edges.for_each_edge([&](std::span<const HalfEdge> halves) {
        const HalfEdge first = halves.front();
        if (!result || halves.size() == 1)
        {
            return;
        }
        const bool agree =
            mesh.triangles[first / 3][first % 3] != mesh.triangles[halves[1] / 3][halves[1] % 3];
        if (halves.size() > 2 || !agree)
        {
            result = not_manifold(
                "face " + std::to_string(first / 3) + " has an edge with " +
                (halves.size() > 2 ? std::to_string(halves.size()) + " faces"
                                   : "a face of the opposite direction")
            );
            return;
        }
        fans.link(mesh.triangles, first, halves[1]);
    });
    return result;
}

Result<void> check_fans(const IndexedMesh& mesh, CornerFans& fans)
{
    std::vector<std::uint32_t> fan_of(mesh.positions.size(), kNoHalfEdge);
    for (std::uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
    {
        const std::uint32_t vertex = mesh.triangles[corner / 3][corner % 3];
        const std::uint32_t fan = fans.find(corner);
        if (fan_of[vertex] != kNoHalfEdge && fan_of[vertex] != fan)
        {
            return not_manifold("vertex " + std::to_string(vertex) + " has several fans of faces");
        }
        fan_of[vertex] = fan;
    }
    for (std::size_t vertex = 0; vertex < fan_of.size(); ++vertex)
    {
        if (fan_of[vertex] == kNoHalfEdge)
        {
            return not_manifold("no face uses vertex " + std::to_string(vertex));
        }
    }
    return {};
}

}  // namespace

Result<void> check_manifold(const IndexedMesh& mesh)
{
    VSPLIT_TRY(check_triangles(mesh));
    CornerFans fans(3 * mesh.triangles.size());
    VSPLIT_TRY(link_edges(mesh, fans));
    return check_fans(mesh, fans);
}

}  // namespace vsplit::precompute
