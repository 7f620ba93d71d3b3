#pragma once

#include "codec/choose.h"
#include "codec/float_log.h"
#include "codec/refinement_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

/// Greatest sum of a face's edge logs.
inline constexpr std::int32_t kMostLogTotal = 3 * 255;

/// Bucket of every ratio of an edge's length to those of the four edges around it, see
/// TraversalView::edge_ratio(); the ratio -2 * kMostLogTotal comes first.
inline constexpr auto kRatioBuckets = [] {
    std::array<std::uint8_t, 2 * kMostLogTotal + 6 * 255 + 1> buckets{};
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(buckets.size()); ++i)
    {
        const std::int32_t ratio = i - 2 * kMostLogTotal;
        buckets[static_cast<std::size_t>(i)] =
            static_cast<std::uint8_t>(clamp_int((ratio + 52) * 13 >> 6, 0, 27));
    }
    return buckets;
}();

/// What the connectivity coder sees of a mesh: edge lengths, states, valences. Holds pointers into the
/// mesh, which must outlive it.
class TraversalView
{
public:
    /// Looks at a mesh whose batch was started.
    explicit TraversalView(RefinementMesh& mesh)
        : faces_(mesh.faces()), points_(mesh.points()), valences_(mesh.valences())
    {
    }

protected:
    /// What the traversal knows of a face's edges.
    struct EdgeView
    {
        std::array<std::int32_t, 3> bucket{};  ///< 1 .. 28: how long; 0: the neighbour is not free.
        std::array<std::int32_t, 3> beyond{};  ///< Sums of the neighbours' edge logs.
        std::int32_t own = 0;                  ///< Sum of the face's edge logs.
        std::int32_t free_neighbours = 0;
        std::int32_t local_log = 0;  ///< Mean edge log of the face and its neighbours.
    };

    static std::int32_t log_total(const Face& face)
    {
        return face.edge_log[0] + face.edge_log[1] + face.edge_log[2];
    }

    /// Length of an edge against the four edges around it, in 1/8 octaves times four.
    std::int32_t edge_ratio(Corner corner) const
    {
        const Face& face = faces_[face_of(corner)];
        const Face& other = faces_[face_of(face.opposite[static_cast<std::size_t>(corner & 3)])];
        return 6 * face.edge_log[static_cast<std::size_t>(corner & 3)] - log_total(face) -
               log_total(other);
    }

    static std::int32_t ratio_bucket(std::int32_t ratio)
    {
        return kRatioBuckets[static_cast<std::size_t>(ratio + kMostLogTotal * 2)];
    }

    bool is_free(Corner corner) const { return faces_[face_of(corner)].state == FaceState::Free; }

    Corner opposite(Corner corner) const
    {
        return faces_[face_of(corner)].opposite[static_cast<std::size_t>(corner & 3)];
    }

    std::uint32_t vertex(Corner corner) const
    {
        return faces_[face_of(corner)].vertex[static_cast<std::size_t>(corner & 3)];
    }

    std::int32_t valence(std::uint32_t vertex) const { return valences_[vertex]; }

    /// Bucket of the edge across from `corner`, plus 1, if the face beyond is free, else 0.
    /// `total`: sum of the edge logs of the corner's face.
    std::int32_t free_edge_bucket(Corner corner, std::int32_t total) const
    {
        const Face& face = faces_[face_of(corner)];
        const auto k = static_cast<std::size_t>(corner & 3);
        const Face& other = faces_[face_of(face.opposite[k])];
        const std::int32_t bucket =
            ratio_bucket(6 * face.edge_log[k] - total - log_total(other)) + 1;
        return bucket & mask_if(other.state == FaceState::Free);
    }

    void prefetch(std::int32_t face, std::int32_t end) const
    {
        constexpr std::int32_t kAhead = 8;
        if (face + kAhead < end)
        {
            for (const Corner corner : faces_[face + kAhead].opposite)
            {
                __builtin_prefetch(&faces_[face_of(corner)]);
            }
        }
    }

    [[gnu::always_inline]] EdgeView view_of(const Face& face) const
    {
        EdgeView view;
        view.own = log_total(face);
        look_beyond<0>(face, view);
        look_beyond<1>(face, view);
        look_beyond<2>(face, view);
        const std::int32_t neighbours = view.beyond[0] + view.beyond[1] + view.beyond[2];
        view.local_log = ((3 * view.own + neighbours) * 57) >> 10;
        return view;
    }

    template <std::size_t k>
    [[gnu::always_inline]] void look_beyond(const Face& face, EdgeView& view) const
    {
        const Face& other = faces_[face_of(face.opposite[k])];
        // A missing neighbour counts as one of the face's own size.
        const std::int32_t total = log_total(other);
        view.beyond[k] = total ^ ((total ^ view.own) & mask_if(other.state == FaceState::Boundary));
        const bool free = other.state == FaceState::Free;
        view.free_neighbours += free ? 1 : 0;
        view.bucket[k] =
            (ratio_bucket(6 * face.edge_log[k] - view.own - view.beyond[k]) + 1) & mask_if(free);
    }

    Face* faces_;
    Point* points_;
    std::uint16_t* valences_;
};

}  // namespace vsplit::codec
