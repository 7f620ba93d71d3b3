#include "mesh/quantization_grid.h"
#include "paper/simplifiers.h"
#include "paper/vectors.h"
#include "precompute/collapse_cost.h"
#include "precompute/collapse_mesh.h"
#include "precompute/half_edge_mesh.h"
#include "precompute/level_builder.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace vsplit::bench {

IndexedMesh without_unused_vertices(const IndexedMesh& mesh)
{
    constexpr std::uint32_t kUnused = 0xFFFFFFFF;
    std::vector<std::uint32_t> place(mesh.positions.size(), kUnused);
    for (const Triangle& triangle : mesh.triangles)
    {
        for (const std::uint32_t v : triangle)
        {
            place[v] = 0;
        }
    }
    IndexedMesh result;
    for (std::size_t v = 0; v < place.size(); ++v)
    {
        if (place[v] != kUnused)
        {
            place[v] = static_cast<std::uint32_t>(result.positions.size());
            result.positions.push_back(mesh.positions[v]);
        }
    }
    for (const auto& [a, b, c] : mesh.triangles)
    {
        result.triangles.push_back({place[a], place[b], place[c]});
    }
    return result;
}

IndexedMesh simplify_by_metric(
    const IndexedMesh& mesh, precompute::Metric metric, std::size_t faces
)
{
    constexpr double kShare = 0.05;
    constexpr int kBits = 12;
    const auto linked = precompute::make_half_edge_mesh(mesh);
    if (!linked)
    {
        throw std::invalid_argument(linked.error().message);
    }
    const QuantizationGrid grid = make_grid(mesh.positions, kBits);
    std::vector<Vector3> points;
    for (const auto& position : mesh.positions)
    {
        points.push_back((position - grid.origin) * (1.0 / grid.cell));
    }
    precompute::CollapseMesh working(static_cast<std::uint32_t>(points.size()), mesh.triangles);
    precompute::CollapseCost cost(
        metric, points, working, precompute::vertex_weights(*linked, metric, 1)
    );
    precompute::LevelBuilder builder(working, cost, points, {});
    IndexedMesh result{mesh.positions, mesh.triangles};
    while (result.triangles.size() > faces)
    {
        // A collapse takes two faces, on a boundary one.
        const std::size_t most = (result.triangles.size() - faces + 1) / 2;
        if (builder.next_level({.largest_share = kShare}, most).empty())
        {
            break;
        }
        result.triangles = working.triangles();
    }
    return without_unused_vertices(result);
}

}  // namespace vsplit::bench
