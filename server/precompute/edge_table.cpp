#include "precompute/edge_table.h"

#include "core/assert.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vsplit::precompute {
namespace {

/// An edge within the bucket of its smaller vertex.
struct BucketEntry
{
    std::uint32_t larger_vertex = 0;
    HalfEdge half = 0;

    friend auto operator<=>(const BucketEntry&, const BucketEntry&) = default;
};

/// First entry of each vertex's bucket, one more for the end.
std::vector<std::uint32_t> bucket_starts(
    std::span<const Triangle> triangles, std::size_t vertex_count
)
{
    std::vector<std::uint32_t> starts(vertex_count + 1, 0);
    for (const Triangle& triangle : triangles)
    {
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            ++starts[std::min(triangle[corner], triangle[(corner + 1) % 3]) + 1];
        }
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    return starts;
}

}  // namespace

EdgeTable::EdgeTable(std::span<const Triangle> triangles, std::size_t vertex_count)
{
    VSPLIT_ASSERT(triangles.size() <= kNoHalfEdge / 3);
    const auto starts = bucket_starts(triangles, vertex_count);
    std::vector<std::uint32_t> fill(starts.begin(), starts.end() - 1);
    std::vector<BucketEntry> entries(3 * triangles.size());
    HalfEdge half = 0;
    for (const Triangle& triangle : triangles)
    {
        for (std::size_t corner = 0; corner < 3; ++corner, ++half)
        {
            const auto [low, high] = std::minmax({triangle[corner], triangle[(corner + 1) % 3]});
            entries[fill[low]++] = {high, half};
        }
    }
    halves_.reserve(entries.size());
    joins_previous_.reserve(entries.size());
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex)
    {
        std::sort(entries.begin() + starts[vertex], entries.begin() + starts[vertex + 1]);
        for (std::uint32_t i = starts[vertex]; i < starts[vertex + 1]; ++i)
        {
            const bool joins =
                i > starts[vertex] && entries[i].larger_vertex == entries[i - 1].larger_vertex;
            halves_.push_back(entries[i].half);
            joins_previous_.push_back(joins ? 1 : 0);
        }
    }
}

CornerFans::CornerFans(std::size_t corner_count) : parents_(corner_count)
{
    std::iota(parents_.begin(), parents_.end(), std::uint32_t{0});
}

void CornerFans::link(std::span<const Triangle> triangles, HalfEdge a, HalfEdge b)
{
    const HalfEdge a_end = next_in_face(a);
    const HalfEdge b_end = next_in_face(b);
    // The faces may still turn opposite ways, so the corners are matched by their vertices.
    const bool opposite = triangles[a / 3][a % 3] == triangles[b_end / 3][b_end % 3];
    unite(a, opposite ? b_end : b);
    unite(a_end, opposite ? b : b_end);
}

std::uint32_t CornerFans::find(std::uint32_t corner)
{
    while (parents_[corner] != corner)
    {
        parents_[corner] = parents_[parents_[corner]];  // path halving
        corner = parents_[corner];
    }
    return corner;
}

void CornerFans::unite(std::uint32_t a, std::uint32_t b)
{
    a = find(a);
    b = find(b);
    // The smaller corner stays the root, which makes the result independent of the order of links.
    parents_[std::max(a, b)] = std::min(a, b);
}

}  // namespace vsplit::precompute
