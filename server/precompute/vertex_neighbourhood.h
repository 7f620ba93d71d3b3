#pragma once

#include "precompute/half_edge_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Returns the neighbour of `vertex` with the smallest index. Precondition: a mesh from
/// make_half_edge_mesh(), in which every vertex has neighbours. Cost: the valence. Thread safe.
[[nodiscard]] std::uint32_t first_neighbour(const HalfEdgeMesh& mesh, std::uint32_t vertex);

/// Finds vertices near a vertex by growing rings over the surface, so that points of another sheet
/// that is near in space but far along the surface never take part. Keeps scratch memory (4 bytes a
/// vertex): one per thread, not thread safe.
class NeighbourhoodSearch
{
public:
    /// `mesh`: from make_half_edge_mesh(); must outlive the search.
    explicit NeighbourhoodSearch(const HalfEdgeMesh& mesh);

    /// Returns the two-ring of `vertex` without the vertex, or its `limit` nearest members where it
    /// is larger. Valid until the next query. Cost: about the size of the two-ring.
    [[nodiscard]] std::span<const std::uint32_t> two_ring(std::uint32_t vertex, std::size_t limit);

    /// Returns the paper's adaptive neighbourhood of `vertex` without the vertex, nearest first: the
    /// candidates inside the ball whose radius is the candidates' mean distance, but at least the 16
    /// and at most the 25 nearest; fewer where the component is smaller. Candidates are the 45
    /// nearest of the rings that hold as many. Valid until the next query.
    /// Source: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", adaptive
    /// neighbourhood; the candidate set is our reading, see vertex_neighbourhood.cpp.
    [[nodiscard]] std::span<const std::uint32_t> adaptive(std::uint32_t vertex);

private:
    struct Candidate
    {
        double squared_distance;
        std::uint32_t vertex;

        friend auto operator<=>(const Candidate&, const Candidate&) = default;
    };

    void grow(std::uint32_t vertex, std::size_t enough, int most_rings);
    void append_ring(std::uint32_t vertex);
    void measure(std::uint32_t vertex);

    const HalfEdgeMesh& mesh_;
    std::vector<std::uint32_t> visited_;  // the stamp of the query that last saw the vertex
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> found_;  // the centre, then ring after ring
    std::vector<Candidate> candidates_;
};

}  // namespace vsplit::precompute
