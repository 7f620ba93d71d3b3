// Based on: Rossignac, Safonova, Szymczak, "3D Compression Made Simple: Edgebreaker on a Corner Table",
// 2001; Hoppe, DeRose, Duchamp, McDonald, Stuetzle, "Mesh Optimization", 1993 (collapse).
#include "precompute/collapse_mesh.h"

#include <algorithm>
#include <array>

namespace vsplit::precompute {
CollapseMesh::CollapseMesh(std::uint32_t vertex_count, std::span<const Triangle> triangles)
    : vertex_(triangles.size() * 3),
      opposite_(triangles.size() * 3, -1),
      corner_of_(vertex_count, -1),
      valence_(vertex_count, 0),
      boundary_(vertex_count, 0)
{
    for (std::size_t c = 0; c < vertex_.size(); ++c)
    {
        const std::uint32_t v = triangles[c / 3][c % 3];
        vertex_[c] = static_cast<std::int32_t>(v);
        corner_of_[v] = static_cast<std::int32_t>(c);
    }
    link_opposites();
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(vertex_.size()); ++c)
    {
        const bool last = opposite(previous(c)) < 0;
        valence_[vertex(c)] += last ? 2 : 1;
        if (last)
        {
            boundary_[vertex(c)] = 1;
            boundary_[vertex(next(c))] = 1;
        }
    }
}

void CollapseMesh::link_opposites()
{
    // Half-edges sorted by their first vertex, by counting.
    std::vector<std::uint32_t> start(corner_of_.size() + 1, 0);
    const auto corners = static_cast<std::int32_t>(vertex_.size());
    for (std::int32_t c = 0; c < corners; ++c)
    {
        ++start[vertex(next(c)) + 1];
    }
    for (std::size_t v = 1; v < start.size(); ++v)
    {
        start[v] += start[v - 1];
    }
    std::vector<std::int32_t> leaving(vertex_.size());
    std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
    for (std::int32_t c = 0; c < corners; ++c)
    {
        leaving[fill[vertex(next(c))]++] = c;
    }
    for (std::int32_t c = 0; c < corners; ++c)
    {
        const std::uint32_t from = vertex(previous(c));
        for (std::uint32_t i = start[from]; i < start[from + 1]; ++i)
        {
            if (vertex(previous(leaving[i])) == vertex(next(c)))
            {
                opposite_[static_cast<std::size_t>(c)] = leaving[i];
                break;
            }
        }
    }
}

bool CollapseMesh::ring(std::uint32_t center, OneRing& ring) const
{
    ring.size = 0;
    ring.boundary = boundary_[center] != 0;
    if (valence_[center] > OneRing::kMost)
    {
        return false;
    }
    std::int32_t corner = first_corner(center);
    const std::int32_t first = corner;
    do
    {
        ring.vertex[ring.size] = vertex(next(corner));
        ring.corner[ring.size++] = corner;
        const std::int32_t across = opposite(next(corner));
        if (across < 0)
        {
            ring.vertex[ring.size] = vertex(previous(corner));
            ring.corner[ring.size++] = -1;
            break;
        }
        corner = next(across);
    }
    while (corner != first);
    ring.face_count = ring.boundary ? ring.size - 1 : ring.size;
    return true;
}

bool CollapseMesh::can_collapse(
    std::uint32_t removed, const OneRing& ring, std::size_t kept, std::uint32_t valence_limit
) const
{
    const std::size_t degree = ring.size;
    const std::uint32_t target = ring.vertex[kept];
    const auto least = [this](std::uint32_t v) { return boundary_[v] != 0 ? 2U : 3U; };
    const auto gained = static_cast<std::uint32_t>(degree) - (ring.boundary ? 3U : 4U);
    const std::uint32_t after = valence_[target] + gained;
    if (after > valence_limit || after < least(target))
    {
        return false;
    }
    // The neighbours on both sides of the collapsed edge lose one neighbour each.
    const std::size_t left = (kept + 1) % degree;
    const std::size_t right = (kept + degree - 1) % degree;
    std::array<std::size_t, 2> losers{left, right};
    if (ring.boundary)
    {
        losers = {kept == 0 ? left : right, kept == 0 ? left : right};
    }
    for (const std::size_t loser : losers)
    {
        const std::uint32_t v = ring.vertex[loser];
        if (valence_[v] <= least(v))
        {
            return false;
        }
    }
    OneRing around;
    if (!this->ring(target, around))
    {
        return false;
    }
    // Link condition: the kept vertex has no neighbour in common with the removed one but those two.
    for (std::size_t i = 0; i < degree; ++i)
    {
        if (i == kept || i == losers[0] || i == losers[1])
        {
            continue;
        }
        const auto end = around.vertex.begin() + static_cast<std::ptrdiff_t>(around.size);
        if (std::find(around.vertex.begin(), end, ring.vertex[i]) != end)
        {
            return false;
        }
    }
    return !is_removed(removed);
}

void CollapseMesh::link(std::int32_t a, std::int32_t b)
{
    if (a >= 0)
    {
        opposite_[static_cast<std::size_t>(a)] = b;
    }
    if (b >= 0)
    {
        opposite_[static_cast<std::size_t>(b)] = a;
    }
}

void CollapseMesh::drop_face(std::int32_t face)
{
    for (std::int32_t c = 3 * face; c < 3 * face + 3; ++c)
    {
        vertex_[static_cast<std::size_t>(c)] = -1;
    }
}

void CollapseMesh::collapse(std::uint32_t removed, const OneRing& ring, std::size_t kept)
{
    const std::size_t degree = ring.size;
    const std::uint32_t target = ring.vertex[kept];
    // Faces on the two sides of the edge removed-kept; on a boundary there is one.
    const bool has_left = !ring.boundary || kept == 0;
    const bool has_right = !ring.boundary || kept != 0;
    const std::int32_t left_corner = has_left ? ring.corner[kept] : -1;
    const std::int32_t right_corner = has_right ? ring.corner[(kept + degree - 1) % degree] : -1;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        vertex_[static_cast<std::size_t>(ring.corner[i])] = static_cast<std::int32_t>(target);
    }
    if (has_left)
    {
        // Face (removed, kept, left): join its outer neighbour with the next face of the ring.
        link(opposite(next(left_corner)), opposite(left_corner));
        --valence_[ring.vertex[(kept + 1) % degree]];
    }
    if (has_right)
    {
        link(opposite(previous(right_corner)), opposite(right_corner));
        --valence_[ring.vertex[(kept + degree - 1) % degree]];
    }
    if (has_left)
    {
        drop_face(left_corner / 3);
    }
    if (has_right)
    {
        drop_face(right_corner / 3);
    }
    // Every vertex of the ring remembers a corner in a face that is left.
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::int32_t corner = ring.corner[i];
        if (corner == left_corner || corner == right_corner)
        {
            continue;
        }
        corner_of_[target] = corner;
        corner_of_[ring.vertex[i]] = next(corner);
        corner_of_[ring.vertex[(i + 1) % degree]] = previous(corner);
    }
    valence_[target] += static_cast<std::uint32_t>(degree) - (ring.boundary ? 3U : 4U);
    corner_of_[removed] = -1;
}

std::vector<Triangle> CollapseMesh::triangles() const
{
    std::vector<Triangle> result;
    for (std::size_t c = 0; c < vertex_.size(); c += 3)
    {
        if (vertex_[c] >= 0)
        {
            result.push_back(
                {static_cast<std::uint32_t>(vertex_[c]),
                 static_cast<std::uint32_t>(vertex_[c + 1]),
                 static_cast<std::uint32_t>(vertex_[c + 2])}
            );
        }
    }
    return result;
}

std::vector<std::uint32_t> CollapseMesh::vertices() const
{
    std::vector<std::uint32_t> result;
    for (std::uint32_t v = 0; v < corner_of_.size(); ++v)
    {
        if (corner_of_[v] >= 0)
        {
            result.push_back(v);
        }
    }
    return result;
}

}  // namespace vsplit::precompute
