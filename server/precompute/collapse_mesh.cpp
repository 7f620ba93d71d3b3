// Based on: Rossignac, Safonova, Szymczak, "3D Compression Made Simple: Edgebreaker on a Corner Table",
// 2001; Hoppe, DeRose, Duchamp, McDonald, Stuetzle, "Mesh Optimization", 1993 (collapse).
#include "precompute/collapse_mesh.h"

#include <algorithm>
#include <array>

namespace vsplit::precompute {
namespace {

constexpr std::uint32_t kMostValence = 0x7FFF'FFFFU;

}  // namespace

CollapseMesh::CollapseMesh(
    std::uint32_t vertex_count,
    std::span<const Triangle> triangles,
    std::span<const Triangle> wedges
)
    : faces_(triangles.size()), links_(vertex_count), wedges_(wedges.begin(), wedges.end())
{
    for (std::size_t f = 0; f < triangles.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::uint32_t v = triangles[f][k];
            faces_[f].vertex[k] = static_cast<std::int32_t>(v);
            links_[v].corner = static_cast<std::int32_t>(4 * f + k);
        }
    }
    link_opposites();
    for_each_corner([this](std::int32_t c) {
        Link& link = links_[vertex(c)];
        const bool last = opposite(previous(c)) < 0;
        link.valence = (link.valence + (last ? 2U : 1U)) & kMostValence;
        if (last)
        {
            link.boundary = 1;
            links_[vertex(next(c))].boundary = 1;
        }
    });
    mark_seams();
}

void CollapseMesh::link_opposites()
{
    // Half-edges sorted by their first vertex, by counting.
    std::vector<std::uint32_t> start(links_.size() + 1, 0);
    for_each_corner([&](std::int32_t c) { ++start[vertex(next(c)) + 1]; });
    for (std::size_t v = 1; v < start.size(); ++v)
    {
        start[v] += start[v - 1];
    }
    std::vector<std::int32_t> leaving(3 * faces_.size());
    std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
    for_each_corner([&](std::int32_t c) { leaving[fill[vertex(next(c))]++] = c; });
    for_each_corner([&](std::int32_t c) {
        const std::uint32_t from = vertex(previous(c));
        for (std::uint32_t i = start[from]; i < start[from + 1]; ++i)
        {
            if (vertex(previous(leaving[i])) == vertex(next(c)))
            {
                set_opposite(c, leaving[i]);
                break;
            }
        }
    });
}

bool CollapseMesh::ring(std::uint32_t center, OneRing& ring) const
{
    ring.size = 0;
    ring.boundary = is_boundary(center);
    if (valence(center) > OneRing::kMost)
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
    const auto least = [this](std::uint32_t v) { return is_boundary(v) ? 2U : 3U; };
    const auto gained = static_cast<std::uint32_t>(degree) - (ring.boundary ? 3U : 4U);
    const std::uint32_t after = valence(target) + gained;
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
        if (valence(v) <= least(v))
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
    return !is_removed(removed) && keeps_seams(removed, ring, kept);
}

void CollapseMesh::link(std::int32_t a, std::int32_t b)
{
    if (a >= 0)
    {
        set_opposite(a, b);
    }
    if (b >= 0)
    {
        set_opposite(b, a);
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
    fold_wedges(ring, kept);
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        Face& face = faces_[static_cast<std::size_t>(ring.corner[i] >> 2)];
        face.vertex[static_cast<std::size_t>(ring.corner[i] & 3)] =
            static_cast<std::int32_t>(target);
    }
    if (has_left)
    {
        // Face (removed, kept, left): join its outer neighbour with the next face of the ring.
        link(opposite(next(left_corner)), opposite(left_corner));
        --links_[ring.vertex[(kept + 1) % degree]].valence;
    }
    if (has_right)
    {
        link(opposite(previous(right_corner)), opposite(right_corner));
        --links_[ring.vertex[(kept + degree - 1) % degree]].valence;
    }
    if (has_left)
    {
        faces_[static_cast<std::size_t>(left_corner >> 2)] = {};
    }
    if (has_right)
    {
        faces_[static_cast<std::size_t>(right_corner >> 2)] = {};
    }
    // Every vertex of the ring remembers a corner in a face that is left.
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::int32_t corner = ring.corner[i];
        if (corner == left_corner || corner == right_corner)
        {
            continue;
        }
        links_[target].corner = corner;
        links_[ring.vertex[i]].corner = next(corner);
        links_[ring.vertex[(i + 1) % degree]].corner = previous(corner);
    }
    links_[target].valence =
        (valence(target) + static_cast<std::uint32_t>(degree) - (ring.boundary ? 3U : 4U)) &
        kMostValence;
    links_[removed].corner = -1;
}

void CollapseMesh::remove_parts(std::span<const Triangle> parts)
{
    for (const Triangle& triangle : parts)
    {
        for (const std::uint32_t v : triangle)
        {
            links_[v].corner = -1;
        }
    }
    for (Face& face : faces_)
    {
        if (face.vertex[0] >= 0 && links_[static_cast<std::size_t>(face.vertex[0])].corner < 0)
        {
            face = {};
        }
    }
}

std::vector<Triangle> CollapseMesh::triangles() const
{
    std::vector<Triangle> result;
    for (std::uint32_t face = 0; face < faces_.size(); ++face)
    {
        if (has_face(face))
        {
            result.push_back(triangle(face));
        }
    }
    return result;
}

std::vector<std::uint32_t> CollapseMesh::vertices() const
{
    std::vector<std::uint32_t> result;
    for (std::uint32_t v = 0; v < links_.size(); ++v)
    {
        if (!is_removed(v))
        {
            result.push_back(v);
        }
    }
    return result;
}

}  // namespace vsplit::precompute
