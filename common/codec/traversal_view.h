#pragma once

#include "codec/float_log.h"
#include "codec/refinement_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

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
        return clamp_int((ratio + 52) * 13 >> 6, 0, 27);
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

    /// Bucket of the edge across from `corner` if the face beyond is free, else `otherwise`.
    std::int32_t free_edge_bucket(Corner corner, std::int32_t otherwise) const
    {
        const Corner across = opposite(corner);
        return is_free(across) ? ratio_bucket(edge_ratio(corner)) + 1 : otherwise;
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

    EdgeView view_of(std::int32_t index) const
    {
        const Face& face = faces_[index];
        const std::int32_t own = log_total(face);
        EdgeView view;
        std::int32_t neighbours = 0;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Face& other = faces_[face_of(face.opposite[k])];
            // A missing neighbour counts as one of the face's own size; selected without branches.
            const std::int32_t boundary =
                -static_cast<std::int32_t>(other.state == FaceState::Boundary);
            const std::int32_t total = log_total(other);
            const std::int32_t beyond = total ^ ((total ^ own) & boundary);
            neighbours += beyond;
            const std::int32_t free = -static_cast<std::int32_t>(other.state == FaceState::Free);
            view.free_neighbours -= free;
            view.bucket[k] = (ratio_bucket(6 * face.edge_log[k] - own - beyond) + 1) & free;
        }
        view.local_log = ((3 * own + neighbours) * 57) >> 10;
        return view;
    }

    Face* faces_;
    Point* points_;
    std::uint16_t* valences_;
};

}  // namespace vsplit::codec
