#pragma once

#include "mesh/indexed_mesh.h"
#include "paper/vectors.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::bench {

/// A face by its corners, the vertex that changes first; `slot` tells where its points are kept.
struct Face
{
    std::size_t slot = 0;
    Triangle corners{};
};

/// What an edge collapse would look like.
struct EdgePlan
{
    std::uint32_t removed = 0;
    std::uint32_t kept = 0;
    std::size_t ring_place = 0;         ///< Of the kept vertex in the removed one's ring.
    precompute::OneRing ring;           ///< Of the removed vertex.
    std::vector<Face> before;           ///< All faces around the two.
    std::vector<Face> after;            ///< The same without those that vanish, in new corners.
    std::vector<std::uint32_t> points;  ///< Those closest to one of the faces.
    std::vector<Vector3> neighbours;    ///< Of the new vertex.
    double spring = 0.0;                ///< Of each edge's squared length.
};

}  // namespace vsplit::bench
