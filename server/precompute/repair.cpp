#include "precompute/repair.h"

#include "format.h"
#include "precompute/mesh_builder.h"
#include "precompute/repair_steps.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace vsplit::precompute {
namespace {

Result<void> check_input(const IndexedMesh& mesh)
{
    if (mesh.positions.size() > proto::kMaxVertices || mesh.triangles.size() > proto::kMaxFaces)
    {
        return fail(ErrorCode::InputTooLarge, "the mesh has too many vertices or faces");
    }
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    {
        if (!is_position(mesh.positions[vertex]))
        {
            return bad_position(vertex);
        }
    }
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
    {
        const auto& [a, b, c] = mesh.triangles[face];
        if (std::max({a, b, c}) >= mesh.positions.size())
        {
            return fail(
                ErrorCode::BadIndex,
                "face " + std::to_string(face) + " refers to a vertex that does not exist"
            );
        }
    }
    return {};
}

void turn_faces(std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& reversed)
{
    for (std::size_t face = 0; face < triangles.size(); ++face)
    {
        if (reversed[face] != 0)
        {
            std::swap(triangles[face][1], triangles[face][2]);
        }
    }
}

/// Counts the sets of vertices that edges connect.
std::uint32_t count_components(const IndexedMesh& mesh)
{
    std::vector<std::uint32_t> parents(mesh.positions.size());
    std::iota(parents.begin(), parents.end(), std::uint32_t{0});
    const auto find = [&](std::uint32_t vertex) {
        while (parents[vertex] != vertex)
        {
            parents[vertex] = parents[parents[vertex]];
            vertex = parents[vertex];
        }
        return vertex;
    };
    auto components = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [a, b, c] : mesh.triangles)
    {
        for (const std::uint32_t vertex : {b, c})
        {
            const std::uint32_t first = find(a);
            const std::uint32_t second = find(vertex);
            components -= first != second ? 1 : 0;
            parents[std::max(first, second)] = std::min(first, second);
        }
    }
    return components;
}

std::uint32_t count_boundary_edges(const IndexedMesh& mesh)
{
    std::uint32_t count = 0;
    const EdgeTable edges(mesh.triangles, mesh.positions.size());
    edges.for_each_edge([&](std::span<const HalfEdge> halves) {
        count += halves.size() == 1 ? 1 : 0;
    });
    return count;
}

}  // namespace

bool RepairReport::clean() const
{
    return welded_vertices == 0 && isolated_vertices == 0 && degenerate_faces == 0 &&
           duplicate_faces == 0 && flipped_faces == 0 && non_manifold_edges == 0 &&
           non_manifold_vertices == 0 && added_vertices == 0;
}

Result<RepairedMesh> repair_mesh(const IndexedMesh& mesh)
{
    VSPLIT_TRY(check_input(mesh));
    RepairedMesh result;
    result.mesh = weld_and_clean(mesh, result.report);
    if (result.mesh.triangles.empty())
    {
        return fail(ErrorCode::EmptyMesh, "no triangle is left after repair");
    }
    const Orientation orientation = orient_faces(result.mesh, result.report);
    result.stitches = split_fans(result.mesh, orientation, result.report);
    turn_faces(result.mesh.triangles, orientation.reversed);
    result.components = count_components(result.mesh);
    result.boundary_edges = count_boundary_edges(result.mesh);
    return result;
}

}  // namespace vsplit::precompute
