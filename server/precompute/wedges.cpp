// Based on: Hoppe, "Efficient Implementation of Progressive Meshes", 1998 (wedges); Tarjan, "Efficiency
// of a Good But Not Linear Set Union Algorithm", 1975 (sectors as sets of corners).
#include "precompute/wedges.h"

#include "precompute/collapse_mesh.h"

#include <algorithm>
#include <numeric>

namespace vsplit::precompute {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// A corner of CollapseMesh as face and place.
struct Place
{
    explicit Place(std::int32_t c)
        : face(static_cast<std::size_t>(c) >> 2), corner(static_cast<std::size_t>(c) & 3)
    {
    }

    [[nodiscard]] std::uint32_t number() const
    {
        return static_cast<std::uint32_t>(3 * face + corner);
    }

    [[nodiscard]] std::uint32_t in(std::span<const Triangle> table) const
    {
        return table[face][corner];
    }

    std::size_t face;
    std::size_t corner;
};

/// Sets of corners.
class CornerSets
{
public:
    explicit CornerSets(std::size_t corners) : parent_(corners)
    {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t find(std::uint32_t corner)
    {
        while (parent_[corner] != corner)
        {
            parent_[corner] = parent_[parent_[corner]];
            corner = parent_[corner];
        }
        return corner;
    }

    /// The least corner stands for its set.
    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// Tells whether the edge between two pairs of corners, one pair at each end, is a seam.
bool is_seam(
    std::span<const std::span<const Triangle>> tables,
    std::span<const std::uint32_t> groups,
    const std::array<std::array<Place, 2>, 2>& ends
)
{
    if (!groups.empty() && groups[ends[0][0].face] != groups[ends[0][1].face])
    {
        return true;
    }
    return std::ranges::any_of(tables, [&](std::span<const Triangle> table) {
        return ends[0][0].in(table) != ends[0][1].in(table) ||
               ends[1][0].in(table) != ends[1][1].in(table);
    });
}

}  // namespace

Wedges split_wedges(
    const IndexedMesh& mesh,
    std::span<const std::span<const Triangle>> tables,
    std::span<const std::uint32_t> groups
)
{
    const CollapseMesh linked(static_cast<std::uint32_t>(mesh.positions.size()), mesh.triangles);
    CornerSets sets(3 * mesh.triangles.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    {
        for (std::int32_t k = 0; k < 3; ++k)
        {
            const std::int32_t corner = static_cast<std::int32_t>(4 * f) + k;
            const std::int32_t across = linked.corner_across(corner);
            if (across < corner)
            {
                continue;  // a boundary, or seen from the other side
            }
            const std::array<std::array<Place, 2>, 2> ends{{
                {Place(CollapseMesh::next(corner)), Place(CollapseMesh::previous(across))},
                {Place(CollapseMesh::previous(corner)), Place(CollapseMesh::next(across))},
            }};
            if (!is_seam(tables, groups, ends))
            {
                sets.join(ends[0][0].number(), ends[0][1].number());
                sets.join(ends[1][0].number(), ends[1][1].number());
            }
        }
    }
    Wedges wedges{.corners = std::vector<Triangle>(mesh.triangles.size())};
    std::vector<std::uint32_t> number(3 * mesh.triangles.size(), kNone);
    for (std::uint32_t corner = 0; corner < number.size(); ++corner)
    {
        const std::uint32_t first = sets.find(corner);
        if (number[first] == kNone)
        {
            number[first] = wedges.count++;
        }
        wedges.corners[corner / 3][corner % 3] = number[first];
    }
    return wedges;
}

}  // namespace vsplit::precompute
