#include "precompute/repair.h"

#include "format.h"
#include "precompute/half_edge_mesh.h"
#include "precompute/mesh_builder.h"
#include "precompute/repair_steps.h"

#include <algorithm>
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

}  // namespace

bool RepairReport::clean() const
{
    return welded_vertices == 0 && isolated_vertices == 0 && degenerate_faces == 0 &&
           duplicate_faces == 0 && flipped_faces == 0 && non_manifold_edges == 0 &&
           non_manifold_vertices == 0 && added_vertices == 0;
}

Result<RepairedMesh> repair_mesh(const IndexedMesh& mesh, std::span<const float> importance)
{
    VSPLIT_TRY(check_input(mesh));
    if (!importance.empty() && importance.size() != mesh.positions.size())
    {
        return fail(
            ErrorCode::UnsupportedInput,
            "there are " + std::to_string(importance.size()) + " marks for " +
                std::to_string(mesh.positions.size()) + " vertices"
        );
    }
    RepairedMesh result;
    result.importance.assign(importance.begin(), importance.end());
    weld_and_clean(mesh, result);
    if (result.mesh.triangles.empty())
    {
        return fail(ErrorCode::EmptyMesh, "no triangle is left after repair");
    }
    Orientation orientation = orient_faces(result.mesh, result.report);
    result.stitches = split_fans(result.mesh, orientation, result.report);
    turn_faces(result.mesh.triangles, orientation.reversed);
    result.turned = std::move(orientation.reversed);
    if (!result.importance.empty())
    {
        // Copies that the cutting made are appended.
        for (std::size_t v = result.importance.size(); v < result.stitches.size(); ++v)
        {
            result.importance.push_back(result.importance[result.stitches[v]]);
        }
    }
    if (result.report.non_manifold_edges == 0 && result.stitches.empty())
    {
        // Nothing was cut: all edges are as the flood fill saw them.
        result.components = orientation.components;
        result.boundary_edges =
            static_cast<std::uint32_t>(std::ranges::count(orientation.opposite, kNoHalfEdge));
        return result;
    }
    const auto linked = make_half_edge_mesh(result.mesh);
    if (!linked)
    {
        const auto& [code, message, offset] = linked.error();
        return fail(
            code == ErrorCode::InputTooLarge ? code : ErrorCode::Internal,
            "repair failed: " + message
        );
    }
    result.components = component_count(*linked);
    result.boundary_edges = boundary_edge_count(*linked);
    return result;
}

}  // namespace vsplit::precompute
