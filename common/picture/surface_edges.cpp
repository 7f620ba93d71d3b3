#include "picture/surface_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vsplit::picture {
namespace {

/// For each vertex the first one at its place.
std::vector<std::uint32_t> weld(const IndexedMesh& mesh)
{
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(mesh.positions[a], a) < std::tie(mesh.positions[b], b);
    });
    std::vector<std::uint32_t> first(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        const bool same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

}  // namespace

std::vector<TriangleSide> sorted_sides(const IndexedMesh& mesh)
{
    const std::vector<std::uint32_t> first = weld(mesh);
    std::vector<TriangleSide> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [low, high] =
                std::minmax({first[triangle[k]], first[triangle[(k + 1) % 3]]});
            sides.push_back({{low, high}, first[triangle[(k + 2) % 3]]});
        }
    }
    std::ranges::sort(sides);
    return sides;
}

}  // namespace vsplit::picture
