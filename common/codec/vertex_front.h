#pragma once

// Based on: Cohen-Or, Cohen, Irony, "Multi-way Geometry Encoding", 2002 (the vertices about which most
// is known come first).

#include "codec/grown_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Number of a vertex that has not been placed.
inline constexpr std::uint32_t kUnknownVertex = 0xFFFFFFFF;

/// A face at a vertex of a grown mesh, seen from that vertex.
struct RingFace
{
    Corner corner = -1;             ///< At the vertex.
    std::uint32_t next = 0;         ///< The vertex after it in the face.
    std::uint32_t previous = 0;     ///< The one before it.
    std::uint32_t next_number = 0;  ///< Its final number, or kUnknownVertex.
    std::uint32_t previous_number = 0;
    bool ends = false;  ///< No face follows across the edge to `previous`.
};

/// Which vertices of a grown mesh are placed, and in which order the others come. Not thread safe.
class VertexFront
{
public:
    /// Corners that may wait at a time in each list for a mesh of so many vertices: far more than
    /// meshes of any use need, few enough to bound the memory.
    [[nodiscard]] static constexpr std::size_t most_waiting(std::uint32_t vertices)
    {
        return vertices / 4 + 4096;
    }

    /// Starts with no vertex of a mesh placed.
    void start(const GrownMesh& mesh)
    {
        number_.assign(mesh.vertex_count(), kUnknownVertex);
        known_faces_.assign(mesh.vertex_count(), 0);
        most_ = most_waiting(mesh.vertex_count());
    }

    /// True when a vertex is placed.
    [[nodiscard]] bool is_known(std::uint32_t vertex) const
    {
        return number_[vertex] != kUnknownVertex;
    }

    /// Final number of a vertex, or kUnknownVertex.
    [[nodiscard]] std::uint32_t number(std::uint32_t vertex) const { return number_[vertex]; }

    /// Final numbers by vertex.
    [[nodiscard]] const std::vector<std::uint32_t>& numbers() const { return number_; }

    /// Vertices placed so far.
    [[nodiscard]] std::uint32_t placed() const { return placed_; }

    /// Takes a corner at the vertex to place next; -1 when there is none left.
    [[nodiscard]] Corner take(const GrownMesh& mesh)
    {
        for (auto* const waiting : {&likely_, &possible_})
        {
            while (!waiting->empty())
            {
                const Corner corner = waiting->back();
                waiting->pop_back();
                if (!is_known(mesh.vertex(corner)))
                {
                    return corner;
                }
            }
        }
        for (; seed_ < mesh.seeds().size(); ++seed_)
        {
            for (Corner k = 0; k < 3; ++k)
            {
                const Corner corner = mesh.seeds()[seed_] * 4 + k;
                if (!is_known(mesh.vertex(corner)))
                {
                    return corner;
                }
            }
        }
        return -1;
    }

    /// Looks at the faces around the vertex of a corner: those of its fan, from the corner on. To be called
    /// once for every vertex, before place(); the result is valid until the next call.
    [[nodiscard]] std::span<const RingFace> look_around(const GrownMesh& mesh, Corner first)
    {
        ring_size_ = 0;
        Corner corner = first;
        do
        {
            corner = see(mesh, corner);
        }
        while (corner >= 0 && corner != first);
        if (corner < 0)
        {
            for (Corner beyond = mesh.opposite(previous_corner(first)); beyond >= 0;
                 beyond = mesh.opposite(previous_corner(corner)))
            {
                corner = previous_corner(beyond);
                static_cast<void>(see(mesh, corner));
            }
        }
        corners_ += ring_size_;
        check_distinct();
        return ring();
    }

    /// True when every fan looked at was all that its vertex has, and no two of a vertex's edges led to
    /// the same one: once all are placed, whether the mesh is a 2-manifold with boundary.
    [[nodiscard]] bool saw_manifold(const GrownMesh& mesh) const
    {
        return distinct_ && corners_ == 3 * std::uint64_t{mesh.face_count()};
    }

    /// Gives the vertex last looked at its number, and its neighbours their turn. False when more would
    /// wait than may.
    [[nodiscard]] bool place(const GrownMesh& mesh, std::uint32_t number)
    {
        number_[mesh.vertex(ring_.front().corner)] = number;
        ++placed_;
        bool fits = true;
        for (const RingFace& face : ring())
        {
            const bool next_known = face.next_number != kUnknownVertex;
            if (next_known == (face.previous_number != kUnknownVertex))
            {
                continue;
            }
            std::uint8_t& faces = known_faces_[next_known ? face.previous : face.next];
            if (faces < 2)
            {
                ++faces;
                const Corner corner = face.corner;
                fits = fits && add(mesh,
                                   faces > 1 ? likely_ : possible_,
                                   next_known ? previous_corner(corner) : next_corner(corner));
            }
        }
        return fits;
    }

private:
    static constexpr std::uint8_t kMark = 0x80;

    /// Adds the face of a corner to the ring. Returns the corner of the face that follows, or -1.
    Corner see(const GrownMesh& mesh, Corner corner)
    {
        const Corner next = next_corner(corner);
        if (ring_size_ == ring_.size())
        {
            ring_.emplace_back();
        }
        RingFace& face = ring_[ring_size_++];
        face.corner = corner;
        face.next = mesh.vertex(next);
        face.previous = mesh.vertex(previous_corner(corner));
        face.next_number = number_[face.next];
        face.previous_number = number_[face.previous];
        const Corner beyond = mesh.opposite(next);
        face.ends = beyond < 0;
        return beyond < 0 ? -1 : next_corner(beyond);
    }

    [[nodiscard]] std::span<const RingFace> ring() const
    {
        return std::span(ring_).first(ring_size_);
    }

    /// Marks the neighbours and takes the marks away again.
    void check_distinct()
    {
        std::uint8_t seen = 0;
        const auto mark = [&](std::uint32_t vertex) {
            seen |= known_faces_[vertex];
            known_faces_[vertex] |= kMark;
        };
        for (const RingFace& face : ring())
        {
            mark(face.next);
            if (face.ends)
            {
                mark(face.previous);
            }
        }
        for (const RingFace& face : ring())
        {
            known_faces_[face.next] &= static_cast<std::uint8_t>(~kMark);
            known_faces_[face.previous] &= static_cast<std::uint8_t>(~kMark);
        }
        distinct_ = distinct_ && (seen & kMark) == 0;
    }

    /// Adds a corner to a list. When that is full, corners whose vertex was placed meanwhile make room.
    bool add(const GrownMesh& mesh, std::vector<Corner>& list, Corner corner)
    {
        if (list.size() == most_)
        {
            std::erase_if(list, [&](Corner waits) { return is_known(mesh.vertex(waits)); });
            if (list.size() > most_ / 2)
            {
                return false;
            }
        }
        list.push_back(corner);
        return true;
    }

    std::vector<std::uint32_t> number_;  ///< By vertex.
    std::vector<std::uint8_t>
        known_faces_;             ///< By vertex: faces with both others known, to 2; kMark.
    std::vector<RingFace> ring_;  ///< Around the vertex last looked at.
    std::size_t ring_size_ = 0;   ///< Those of them that are in use.
    std::uint64_t corners_ = 0;   ///< In all rings.
    bool distinct_ = true;
    std::vector<Corner> likely_;    ///< At vertices with two such faces or more.
    std::vector<Corner> possible_;  ///< At vertices with one.
    std::size_t most_ = 0;
    std::size_t seed_ = 0;
    std::uint32_t placed_ = 0;
};

}  // namespace vsplit::codec
