// Based on: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", adaptive
// neighbourhood (16 to 25 nearest neighbours, ball of mean neighbour distance).
// Our reading: the paper's full text was not at hand. It names neither the set over which the mean
// distance is taken nor how neighbours are searched. We take the mean over the 45 nearest vertices
// reached by growing rings: on an evenly sampled surface the ball of mean distance then holds 4/9 of
// them, 20, the middle of the paper's range; it holds more where the centre is sampled more densely
// than its surroundings and fewer where it is sparser.
#include "precompute/vertex_neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsplit::precompute {

namespace {

constexpr std::size_t kLeastNeighbours = 16;
constexpr std::size_t kMostNeighbours = 25;
constexpr std::size_t kCandidates = 45;
// Rings grow without bound only along a strip one triangle wide; there 12 rings hold 24 vertices.
constexpr int kMostRings = 12;
// A hub of thousands of triangles would make the query of each of its neighbours as long: growth stops
// in the middle of such a ring.
constexpr std::size_t kMostVisited = 512;

}  // namespace

std::uint32_t first_neighbour(const HalfEdgeMesh& mesh, std::uint32_t vertex)
{
    int first = std::numeric_limits<int>::max();
    for (const auto neighbour : mesh.vv_range(vertex_handle(vertex)))
    {
        first = std::min(first, neighbour.idx());
    }
    return static_cast<std::uint32_t>(first);
}

NeighbourhoodSearch::NeighbourhoodSearch(const HalfEdgeMesh& mesh)
    : mesh_(mesh), visited_(mesh.n_vertices(), 0)
{
}

void NeighbourhoodSearch::grow(std::uint32_t vertex, std::size_t enough, int most_rings)
{
    if (++stamp_ == 0)  // stamps wrapped round: old ones could look new
    {
        std::fill(visited_.begin(), visited_.end(), 0);
        stamp_ = 1;
    }
    found_.assign(1, vertex);
    visited_[vertex] = stamp_;
    std::size_t ring_begin = 0;
    for (int ring = 0; ring < most_rings && found_.size() <= enough; ++ring)
    {
        const std::size_t ring_end = found_.size();
        for (; ring_begin < ring_end; ++ring_begin)
        {
            append_ring(found_[ring_begin]);
        }
    }
}

void NeighbourhoodSearch::append_ring(std::uint32_t vertex)
{
    for (const auto handle : mesh_.vv_range(vertex_handle(vertex)))
    {
        const auto neighbour = static_cast<std::uint32_t>(handle.idx());
        if (found_.size() > kMostVisited)
        {
            return;
        }
        if (visited_[neighbour] != stamp_)
        {
            visited_[neighbour] = stamp_;
            found_.push_back(neighbour);
        }
    }
}

void NeighbourhoodSearch::measure(std::uint32_t vertex)
{
    const auto& centre = mesh_.point(vertex_handle(vertex));
    candidates_.clear();
    for (std::size_t i = 1; i < found_.size(); ++i)
    {
        const auto& point = mesh_.point(vertex_handle(found_[i]));
        const double dx = point[0] - centre[0];
        const double dy = point[1] - centre[1];
        const double dz = point[2] - centre[2];
        candidates_.push_back({dx * dx + dy * dy + dz * dz, found_[i]});
    }
}

std::span<const std::uint32_t> NeighbourhoodSearch::two_ring(
    std::uint32_t vertex, std::size_t limit
)
{
    grow(vertex, kMostVisited, 2);
    if (found_.size() - 1 > limit)
    {
        measure(vertex);
        const auto cut = candidates_.begin() + static_cast<std::ptrdiff_t>(limit);
        std::nth_element(candidates_.begin(), cut, candidates_.end());
        found_.resize(limit + 1);
        std::transform(candidates_.begin(), cut, found_.begin() + 1, [](const Candidate& c) {
            return c.vertex;
        });
        // Sums over the result must not depend on how a standard library selects.
        std::sort(found_.begin() + 1, found_.end());
    }
    return std::span(found_).subspan(1);
}

std::span<const std::uint32_t> NeighbourhoodSearch::adaptive(std::uint32_t vertex)
{
    grow(vertex, kCandidates, kMostRings);
    measure(vertex);
    std::sort(candidates_.begin(), candidates_.end());
    candidates_.resize(std::min(candidates_.size(), kCandidates));
    double sum = 0.0;
    for (const Candidate& candidate : candidates_)
    {
        sum += std::sqrt(candidate.squared_distance);
    }
    // A hair more, so that rounding does not decide about points at exactly the mean distance.
    const double radius =
        (1.0 + 1e-9) * sum / static_cast<double>(std::max<std::size_t>(1, candidates_.size()));
    const auto outside =
        std::find_if(candidates_.begin(), candidates_.end(), [radius](const Candidate& c) {
            return !(c.squared_distance <= radius * radius);
        });
    const auto inside_count = static_cast<std::size_t>(outside - candidates_.begin());
    const std::size_t count =
        std::min(std::clamp(inside_count, kLeastNeighbours, kMostNeighbours), candidates_.size());
    found_.resize(count);
    std::transform(
        candidates_.begin(),
        candidates_.begin() + static_cast<std::ptrdiff_t>(count),
        found_.begin(),
        [](const Candidate& c) { return c.vertex; }
    );
    return found_;
}

}  // namespace vsplit::precompute
