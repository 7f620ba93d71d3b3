#pragma once

#include "mesh/indexed_mesh.h"
#include "mesh/triangle_lanes.h"
#include "precompute/collapse_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vsplit::precompute {

/// The faces around a vertex with their positions in lanes, for distances to all of them.
class FaceFan
{
public:
    /// Faces that are looked at; those of a larger fan are left out.
    static constexpr std::size_t kMostFaces = 64;

    /// Where a point is closest to the fan.
    struct Closest
    {
        float square = std::numeric_limits<float>::infinity();
        std::uint32_t face = 0;
        /// Corner of that face, other than a hub, with the largest share in the closest point.
        std::uint32_t corner = 0;
    };

    /// Collects the fan of a vertex that is not removed. `position_of(v)`: std::array<float, 3>.
    /// Cost: the valence. Keeps a reference to nothing.
    template <typename PositionOf>
    void collect(const CollapseMesh& mesh, std::uint32_t vertex, const PositionOf& position_of)
    {
        const auto append = [&](std::uint32_t v) {
            const std::array<float, 3> position = position_of(v);
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                ring_[axis][size_] = position[axis];
            }
            vertex_[size_++] = v;
        };
        centre_vertex_ = vertex;
        centre_ = position_of(vertex);
        size_ = 0;
        std::int32_t corner = mesh.first_corner(vertex);
        const std::int32_t first = corner;
        append(mesh.vertex(CollapseMesh::next(corner)));
        do
        {
            face_[size_ - 1] = static_cast<std::uint32_t>(corner >> 2);
            append(mesh.vertex(CollapseMesh::previous(corner)));
            corner = mesh.next_around(corner);
        }
        while (corner >= 0 && corner != first && size_ <= kMostFaces);
        // Lanes beyond the last face hold its last edge once more.
        for (std::size_t i = size_; i < size_ + lanes::kLanes; ++i)
        {
            for (auto& axis : ring_)
            {
                axis[i] = axis[size_ - 1];
            }
        }
    }

    /// Finds the closest face. `mesh`: the one collected from. Cost: a few nanoseconds a face.
    [[nodiscard]] Closest closest(const CollapseMesh& mesh, const std::array<float, 3>& point)
        const;

private:
    static constexpr std::size_t kRoom = kMostFaces + 1 + lanes::kLanes;

    [[nodiscard]] std::array<float, 3> ring_point(std::size_t i) const
    {
        return {ring_[0][i], ring_[1][i], ring_[2][i]};
    }

    std::array<float, 3> centre_{};
    std::uint32_t centre_vertex_ = 0;
    std::size_t size_ = 0;  ///< Ring vertices, one more than faces; a closed ring ends as it began.
    std::array<std::array<float, kRoom>, 3> ring_;
    std::array<std::uint32_t, kRoom> vertex_;
    std::array<std::uint32_t, kRoom> face_;
};

/// Returns the shares of a triangle's corners in its point closest to `point`; they add up to 1.
/// Source: Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] std::array<float, 3> closest_shares(
    const std::array<float, 3>& point,
    const std::array<float, 3>& a,
    const std::array<float, 3>& b,
    const std::array<float, 3>& c
);

/// Finds the closest point of a surface by walking: from fan to fan as long as the distance falls.
/// `start`: a vertex near the point, not removed. Result: never less than the distance to the whole
/// surface, more where the walk ends in a local minimum. Cost: one or two fans.
template <typename PositionOf>
[[nodiscard]] FaceFan::Closest walk_to_closest(
    const CollapseMesh& mesh,
    const std::array<float, 3>& point,
    std::uint32_t start,
    const PositionOf& position_of
)
{
    constexpr int kMostSteps = 16;
    FaceFan fan;
    FaceFan::Closest best;
    std::uint32_t vertex = start;
    for (int step = 0; step < kMostSteps; ++step)
    {
        fan.collect(mesh, vertex, position_of);
        const FaceFan::Closest found = fan.closest(mesh, point);
        if (!(found.square < best.square))
        {
            break;
        }
        best = found;
        if (found.corner == vertex)
        {
            break;
        }
        vertex = found.corner;
    }
    return best;
}

}  // namespace vsplit::precompute
