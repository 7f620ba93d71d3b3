#pragma once

// Based on: Cohen-Or, Cohen, Irony, "Multi-way Geometry Encoding", 2002 (the vertices about which most
// is known come first).

#include "codec/grown_mesh.h"

#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// Number of a vertex that has not been placed.
inline constexpr std::uint32_t kUnknownVertex = 0xFFFFFFFF;

/// Calls `use(corner)` for every corner of a mesh at the vertex of `first`, in turn.
template <typename Use>
void for_each_corner_around(const GrownMesh& mesh, Corner first, const Use& use)
{
    Corner corner = first;
    do
    {
        use(corner);
        const Corner beyond = mesh.opposite(next_corner(corner));
        corner = beyond < 0 ? -1 : next_corner(beyond);
    }
    while (corner >= 0 && corner != first);
    if (corner >= 0)
    {
        return;
    }
    for (Corner beyond = mesh.opposite(previous_corner(first)); beyond >= 0;
         beyond = mesh.opposite(previous_corner(corner)))
    {
        corner = previous_corner(beyond);
        use(corner);
    }
}

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

    /// Gives the memory of the numbers away; only for when they are not needed any more.
    [[nodiscard]] std::vector<std::uint32_t>& release() { return number_; }

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

    /// Gives the vertex of a corner its number, and its neighbours their turn. False when more would
    /// wait than may.
    [[nodiscard]] bool place(const GrownMesh& mesh, Corner corner, std::uint32_t number)
    {
        number_[mesh.vertex(corner)] = number;
        ++placed_;
        bool fits = true;
        for_each_corner_around(mesh, corner, [&](Corner at) {
            const Corner next = next_corner(at);
            const Corner previous = previous_corner(at);
            const bool next_known = is_known(mesh.vertex(next));
            if (next_known == is_known(mesh.vertex(previous)))
            {
                return;
            }
            const Corner waiting = next_known ? previous : next;
            std::uint8_t& faces = known_faces_[mesh.vertex(waiting)];
            if (faces < 2)
            {
                ++faces;
                fits = fits && add(mesh, faces > 1 ? likely_ : possible_, waiting);
            }
        });
        return fits;
    }

private:
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

    std::vector<std::uint32_t> number_;      ///< By vertex.
    std::vector<std::uint8_t> known_faces_;  ///< By vertex: faces with both others known, to 2.
    std::vector<Corner> likely_;             ///< At vertices with two such faces or more.
    std::vector<Corner> possible_;           ///< At vertices with one.
    std::size_t most_ = 0;
    std::size_t seed_ = 0;
    std::uint32_t placed_ = 0;
};

}  // namespace vsplit::codec
