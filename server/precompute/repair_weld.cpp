#include "precompute/repair_steps.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vsplit::precompute {
namespace {

/// A vertex as it is sorted: equal positions side by side, the smallest index first.
struct PlacedVertex
{
    std::array<double, 3> point{};
    std::uint32_t vertex = 0;

    friend auto operator<=>(const PlacedVertex&, const PlacedVertex&) = default;
};

/// A triangle as it is sorted among those with its smallest vertex: equal ones side by side, the smallest
/// face first.
struct SortedFace
{
    std::uint32_t middle = 0;   ///< Vertex.
    std::uint32_t largest = 0;  ///< Vertex.
    std::uint32_t face = 0;

    friend auto operator<=>(const SortedFace&, const SortedFace&) = default;
};

std::vector<std::uint8_t> used_vertices(
    std::span<const Triangle> triangles, std::size_t vertex_count
)
{
    std::vector<std::uint8_t> used(vertex_count, 0);
    for (const Triangle& triangle : triangles)
    {
        for (const std::uint32_t vertex : triangle)
        {
            used[vertex] = 1;
        }
    }
    return used;
}

/// Returns for every vertex the smallest one at its position.
std::vector<std::uint32_t> weld(
    const IndexedMesh& mesh, const std::vector<std::uint8_t>& used, RepairReport& report
)
{
    std::vector<PlacedVertex> placed;
    placed.reserve(mesh.positions.size());
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    {
        if (used[vertex] != 0)
        {
            const auto& [x, y, z] = mesh.positions[vertex];
            placed.push_back({{x + 0.0, y + 0.0, z + 0.0}, vertex});  // -0 becomes 0
        }
    }
    std::sort(placed.begin(), placed.end());
    std::vector<std::uint32_t> representative(mesh.positions.size());
    std::iota(representative.begin(), representative.end(), std::uint32_t{0});
    for (std::size_t i = 1; i < placed.size(); ++i)
    {
        if (placed[i].point == placed[i - 1].point)
        {
            representative[placed[i].vertex] = representative[placed[i - 1].vertex];
            ++report.welded_vertices;
        }
    }
    return representative;
}

/// Marks every triangle that has the vertices of an earlier one. Only triangles with the same smallest
/// vertex are compared. `vertex_count`: the indices are smaller.
std::vector<std::uint8_t> find_duplicates(
    std::span<const Triangle> triangles, std::size_t vertex_count
)
{
    std::vector<std::uint32_t> starts(vertex_count + 1, 0);
    for (const Triangle& triangle : triangles)
    {
        ++starts[std::ranges::min(triangle) + 1];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::uint32_t> fill(starts.begin(), starts.end() - 1);
    std::vector<SortedFace> rows(triangles.size());
    for (std::uint32_t face = 0; face < triangles.size(); ++face)
    {
        const auto& [a, b, c] = triangles[face];
        const std::uint32_t low = std::min({a, b, c});
        const std::uint32_t high = std::max({a, b, c});
        rows[fill[low]++] = {a ^ b ^ c ^ low ^ high, high, face};
    }
    std::vector<std::uint8_t> duplicate(triangles.size(), 0);
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex)
    {
        std::sort(rows.begin() + starts[vertex], rows.begin() + starts[vertex + 1]);
        for (std::uint32_t i = starts[vertex] + 1; i < starts[vertex + 1]; ++i)
        {
            const bool same =
                rows[i].middle == rows[i - 1].middle && rows[i].largest == rows[i - 1].largest;
            duplicate[rows[i].face] = same ? 1 : 0;
        }
    }
    return duplicate;
}

/// Fills triangles and source faces of `result`.
void clean_triangles(
    std::span<const Triangle> triangles,
    const std::vector<std::uint32_t>& representative,
    RepairedMesh& result
)
{
    std::vector<Triangle>& proper = result.mesh.triangles;
    std::vector<std::uint32_t>& sources = result.source_faces;
    proper.reserve(triangles.size());
    sources.reserve(triangles.size());
    for (std::uint32_t face = 0; face < triangles.size(); ++face)
    {
        const auto& [first, second, third] = triangles[face];
        const Triangle welded{representative[first], representative[second], representative[third]};
        const auto& [a, b, c] = welded;
        if (a == b || b == c || c == a)
        {
            ++result.report.degenerate_faces;
            continue;
        }
        proper.push_back(welded);
        sources.push_back(face);
    }
    const auto duplicate = find_duplicates(proper, representative.size());
    std::size_t kept = 0;
    for (std::size_t face = 0; face < proper.size(); ++face)
    {
        if (duplicate[face] == 0)
        {
            sources[kept] = sources[face];
            proper[kept++] = proper[face];
        }
    }
    result.report.duplicate_faces = static_cast<std::uint32_t>(proper.size() - kept);
    proper.resize(kept);
    sources.resize(kept);
}

/// Moves importance from the vertices of the input to those that they became.
void follow_vertices(
    std::vector<float>& importance,
    const std::vector<std::uint32_t>& representative,
    const std::vector<std::uint8_t>& used,
    const std::vector<std::uint32_t>& renumbered
)
{
    std::vector<float> result;
    for (std::size_t vertex = 0; vertex < importance.size(); ++vertex)
    {
        const std::uint32_t kept = representative[vertex];
        if (used[kept] == 0)
        {
            continue;
        }
        // A representative is the smallest of its vertices, so it comes first.
        if (kept == vertex)
        {
            result.push_back(importance[vertex]);
        }
        float& largest = result[renumbered[kept]];
        largest = std::max(largest, importance[vertex]);
    }
    importance = std::move(result);
}

}  // namespace

void weld_and_clean(const IndexedMesh& mesh, RepairedMesh& result)
{
    const std::size_t count = mesh.positions.size();
    const auto representative = weld(mesh, used_vertices(mesh.triangles, count), result.report);
    clean_triangles(mesh.triangles, representative, result);

    const auto used = used_vertices(result.mesh.triangles, count);
    std::vector<std::uint32_t> renumbered(count, 0);
    for (std::size_t vertex = 0; vertex < count; ++vertex)
    {
        if (used[vertex] != 0)
        {
            renumbered[vertex] = static_cast<std::uint32_t>(result.mesh.positions.size());
            result.mesh.positions.push_back(mesh.positions[vertex]);
        }
    }
    result.report.isolated_vertices =
        static_cast<std::uint32_t>(count - result.mesh.positions.size()) -
        result.report.welded_vertices;
    for (Triangle& triangle : result.mesh.triangles)
    {
        for (std::uint32_t& vertex : triangle)
        {
            vertex = renumbered[vertex];
        }
    }
    follow_vertices(result.importance, representative, used, renumbered);
}

}  // namespace vsplit::precompute
