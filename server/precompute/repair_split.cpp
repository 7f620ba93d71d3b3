// Based on: Guéziec, Taubin, Lazarus, Horn, "Cutting and Stitching: Converting Sets of Polygons to
// Manifold Surfaces", 2001 (the local method: multiply the corners, then join those of linked faces).
#include "precompute/repair_steps.h"

#include <numeric>

namespace vsplit::precompute {
namespace {

CornerFans link_fans(const IndexedMesh& mesh, const Orientation& orientation)
{
    CornerFans fans(orientation.opposite.size());
    for (HalfEdge half = 0; half < orientation.opposite.size(); ++half)
    {
        const HalfEdge other = orientation.opposite[half];
        if (other != kNoHalfEdge && half < other)
        {
            fans.link(mesh.triangles, half, other);
        }
    }
    return fans;
}

}  // namespace

std::vector<std::uint32_t> split_fans(
    IndexedMesh& mesh, const Orientation& orientation, RepairReport& report
)
{
    CornerFans fans = link_fans(mesh, orientation);
    const auto source_count = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<std::uint32_t> first_fan(source_count, kNoHalfEdge);
    std::vector<std::uint8_t> was_cut(source_count, 0);
    // Corners are visited in order and a fan's root is its smallest corner, so every fan meets its
    // root first; the root's new vertex is found again through the root's own triangle.
    std::vector<std::uint32_t> sources;
    for (std::uint32_t corner = 0; corner < orientation.opposite.size(); ++corner)
    {
        std::uint32_t& vertex = mesh.triangles[corner / 3][corner % 3];
        const std::uint32_t root = fans.find(corner);
        if (root != corner)
        {
            vertex = mesh.triangles[root / 3][root % 3];
            continue;
        }
        if (first_fan[vertex] == kNoHalfEdge)
        {
            first_fan[vertex] = root;
            continue;
        }
        report.non_manifold_vertices += was_cut[vertex] == 0 ? 1 : 0;
        was_cut[vertex] = 1;
        sources.push_back(vertex);
        mesh.positions.push_back(mesh.positions[vertex]);
        vertex = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
    report.added_vertices = static_cast<std::uint32_t>(sources.size());
    if (sources.empty())
    {
        return {};
    }
    std::vector<std::uint32_t> stitches(source_count);
    std::iota(stitches.begin(), stitches.end(), std::uint32_t{0});
    stitches.insert(stitches.end(), sources.begin(), sources.end());
    return stitches;
}

}  // namespace vsplit::precompute
