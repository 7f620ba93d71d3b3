// Based on: Hoppe, "Efficient Implementation of Progressive Meshes", 1998 (wedges); Dey, Edelsbrunner,
// Guha, Nekhayev, "Topology Preserving Edge Contraction", 1999 (link condition of a subcomplex).
#include "precompute/collapse_mesh.h"

namespace vsplit::precompute {
namespace {

/// Corners at the removed vertex of the faces on the two sides of the edge removed - kept; -1 where
/// there is none.
struct Sides
{
    Sides(const OneRing& ring, std::size_t kept)
    {
        if (!ring.boundary || kept == 0)
        {
            right = ring.corner[kept];
        }
        if (!ring.boundary || kept != 0)
        {
            left = ring.corner[(kept + ring.size - 1) % ring.size];
        }
    }

    std::int32_t right = -1;  ///< In the face (removed, kept, right).
    std::int32_t left = -1;   ///< In the face (removed, left, kept).
};

}  // namespace

void CollapseMesh::mark_seams()
{
    if (wedges_.empty())
    {
        return;
    }
    on_seam_.resize(links_.size(), 0);
    for_each_corner([this](std::int32_t c) {
        if (is_seam(c))
        {
            on_seam_[vertex(next(c))] = 1;
            on_seam_[vertex(previous(c))] = 1;
        }
    });
}

bool CollapseMesh::is_seam(std::int32_t c) const
{
    const std::int32_t across = opposite(c);
    return across >= 0 &&
           (wedge(next(c)) != wedge(previous(across)) || wedge(previous(c)) != wedge(next(across)));
}

std::size_t CollapseMesh::seams_at(const OneRing& ring) const
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        count += is_seam(previous(ring.corner[i])) ? 1 : 0;
    }
    return count;
}

bool CollapseMesh::keeps_seams(std::uint32_t removed, const OneRing& ring, std::size_t kept) const
{
    // The inside of a chart, and of its outer boundary, is all one wedge.
    if (!is_on_seam(removed))
    {
        return true;
    }
    // Where a seam meets the boundary its end stays: one face cannot tell where two wedges go on.
    if (ring.boundary)
    {
        return false;
    }
    const std::uint32_t target = ring.vertex[kept];
    const std::size_t seams = seams_at(ring);
    const Sides sides(ring, kept);
    const bool along = is_seam(previous(sides.right));
    if (seams == 1)
    {
        // The end of a seam moves freely, but may not touch another one nor shorten its own to nothing.
        return !is_on_seam(target) && !is_boundary(target);
    }
    // Inner vertices of a seam move along it; where three meet they stay.
    if (seams != 2 || !along || wedge(next(sides.right)) == wedge(previous(sides.left)))
    {
        return false;
    }
    // A face between two seams, or between a seam and the boundary, may be all that is left of a chart.
    const auto is_border = [this](std::int32_t c) { return opposite(c) < 0 || is_seam(c); };
    return !(is_seam(next(sides.right)) && is_border(sides.right)) &&
           !(is_seam(previous(sides.left)) && is_border(sides.left));
}

std::uint32_t CollapseMesh::next_wedge(const OneRing& ring, std::size_t kept, std::uint32_t wedge)
    const
{
    const Sides sides(ring, kept);
    if (sides.right >= 0 && this->wedge(sides.right) == wedge)
    {
        return this->wedge(next(sides.right));
    }
    return this->wedge(sides.left >= 0 ? previous(sides.left) : next(sides.right));
}

void CollapseMesh::fold_wedges(const OneRing& ring, std::size_t kept)
{
    if (wedges_.empty())
    {
        return;
    }
    // The faces at the collapsed edge vanish, and are asked where the others go on.
    const Sides sides(ring, kept);
    const std::uint32_t removed = vertex(ring.corner[0]);
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::int32_t c = ring.corner[i];
        if (c != sides.right && c != sides.left)
        {
            const auto face = static_cast<std::size_t>(c >> 2);
            wedges_[face][static_cast<std::size_t>(c & 3)] = next_wedge(ring, kept, wedge(c));
        }
    }
    on_seam_[ring.vertex[kept]] |= on_seam_[removed];
}

codec::SeamRecord CollapseMesh::seam_record(const OneRing& ring, std::size_t kept) const
{
    codec::SeamRecord record;
    const Sides sides(ring, kept);
    if (const std::int32_t c = sides.right; c >= 0)
    {
        record.wedges[0] = {wedge(next(c)), wedge(previous(c)), wedge(c)};
        record.faces[0] = static_cast<std::uint32_t>(c >> 2);
    }
    if (const std::int32_t c = sides.left; c >= 0)
    {
        record.wedges[1] = {wedge(previous(c)), wedge(c), wedge(next(c))};
        record.faces[1] = static_cast<std::uint32_t>(c >> 2);
    }
    return record;
}

std::vector<std::uint32_t> CollapseMesh::faces() const
{
    std::vector<std::uint32_t> result;
    for (std::uint32_t face = 0; face < faces_.size(); ++face)
    {
        if (has_face(face))
        {
            result.push_back(face);
        }
    }
    return result;
}

std::vector<Triangle> CollapseMesh::wedges() const
{
    std::vector<Triangle> result;
    for (std::uint32_t face = 0; face < wedges_.size(); ++face)
    {
        if (has_face(face))
        {
            result.push_back(wedges_[face]);
        }
    }
    return result;
}

}  // namespace vsplit::precompute
