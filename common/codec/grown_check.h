#pragma once

#include "codec/vertex_front.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace vsplit::codec {

/// Says whether a grown mesh is a 2-manifold with boundary: the faces around every vertex form one fan,
/// and no two of its edges lead to the same vertex. `corner`, `seen`: room for one entry a vertex.
/// Cost: linear. Safe on untrusted input.
[[nodiscard]] inline bool is_manifold(
    const GrownMesh& mesh, std::span<std::uint32_t> corner, std::span<std::int32_t> seen
)
{
    const auto faces = static_cast<std::int32_t>(mesh.face_count());
    for (Corner c = 0; c < 4 * faces; ++c)
    {
        if ((c & 3) < 3)
        {
            corner[mesh.vertex(c)] = static_cast<std::uint32_t>(c);
        }
    }
    std::ranges::fill(seen, -1);
    std::uint64_t corners = 0;
    bool distinct = true;
    for (std::uint32_t v = 0; distinct && v < mesh.vertex_count(); ++v)
    {
        const auto see = [&](std::uint32_t neighbour) {
            distinct = distinct && seen[neighbour] != static_cast<std::int32_t>(v);
            seen[neighbour] = static_cast<std::int32_t>(v);
        };
        for_each_corner_around(mesh, static_cast<Corner>(corner[v]), [&](Corner at) {
            ++corners;
            see(mesh.vertex(next_corner(at)));
            if (mesh.opposite(next_corner(at)) < 0)
            {
                see(mesh.vertex(previous_corner(at)));
            }
        });
    }
    // Every fan has its own corners, so one fan a vertex makes all of them.
    return distinct && corners == 3 * std::uint64_t{mesh.face_count()};
}

}  // namespace vsplit::codec
