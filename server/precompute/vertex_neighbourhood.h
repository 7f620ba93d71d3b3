#pragma once

#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// The one-ring of every vertex: all vertices that share an edge with it, in ascending order.
/// Immutable once built, so queries are thread safe.
class OneRings
{
public:
    /// Builds all rings. `mesh`: any triangles, also non-manifold or degenerate ones; indices in
    /// range. Cost: linear, about 150 ns a vertex; 32 bytes a vertex of a closed mesh.
    explicit OneRings(const IndexedMesh& mesh);

    /// The ring of `vertex`; empty for an isolated vertex. Valid as long as this object.
    [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t vertex) const
    {
        return std::span(neighbours_)
            .subspan(offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]);
    }

private:
    std::vector<std::size_t> offsets_;  // V + 1
    std::vector<std::uint32_t> neighbours_;
};

/// Finds vertices near a vertex by growing rings over the surface, so that points of another sheet
/// that is near in space but far along the surface never take part. Keeps scratch memory (4 bytes a
/// vertex): one per thread, not thread safe.
class NeighbourhoodSearch
{
public:
    /// `mesh` and its `rings` must outlive the search.
    NeighbourhoodSearch(const IndexedMesh& mesh, const OneRings& rings);

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
    void measure(std::uint32_t vertex);

    const IndexedMesh& mesh_;
    const OneRings& rings_;
    std::vector<std::uint32_t> visited_;  // the stamp of the query that last saw the vertex
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> found_;  // the centre, then ring after ring
    std::vector<Candidate> candidates_;
};

}  // namespace vsplit::precompute
