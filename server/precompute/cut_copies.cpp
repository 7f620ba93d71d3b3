// Based on: Guéziec, Taubin, Lazarus, Horn, "Cutting and Stitching: Converting Sets of Polygons to
// Manifold Surfaces", 2001 (copies of cut vertices); Popović, Hoppe, "Progressive Simplicial Complexes",
// 1997 (what hangs together in an edge is contracted together).
#include "precompute/cut_copies.h"

#include <algorithm>
#include <utility>

namespace vsplit::precompute {

std::vector<std::uint8_t> mark_copies(std::span<const std::uint32_t> stitches)
{
    std::vector<std::uint8_t> marked(stitches.size(), 0);
    for (std::uint32_t v = 0; v < stitches.size(); ++v)
    {
        if (stitches[v] != v)
        {
            marked[v] = 1;
            marked[stitches[v]] = 1;
        }
    }
    return marked;
}

CutCopies::CutCopies(std::span<const std::uint32_t> stitches) : stitches_(stitches)
{
    const std::vector<std::uint8_t> marked = mark_copies(stitches);
    for (std::uint32_t v = 0; v < stitches.size(); ++v)
    {
        if (marked[v] != 0)
        {
            copies_.push_back(v);
        }
    }
    std::ranges::stable_sort(copies_, {}, [&](std::uint32_t v) { return stitches[v]; });
    group();
}

void CutCopies::group()
{
    sources_.clear();
    first_.clear();
    std::vector<std::uint32_t> several;
    for (std::size_t begin = 0; begin < copies_.size();)
    {
        std::size_t end = begin + 1;
        while (end < copies_.size() && source(copies_[end]) == source(copies_[begin]))
        {
            ++end;
        }
        if (end - begin > 1)
        {
            sources_.push_back(source(copies_[begin]));
            first_.push_back(static_cast<std::uint32_t>(several.size()));
            several.insert(
                several.end(),
                copies_.begin() + static_cast<std::ptrdiff_t>(begin),
                copies_.begin() + static_cast<std::ptrdiff_t>(end)
            );
        }
        begin = end;
    }
    first_.push_back(static_cast<std::uint32_t>(several.size()));
    copies_ = std::move(several);
}

void CutCopies::forget_removed(const CollapseMesh& mesh)
{
    if (std::erase_if(copies_, [&](std::uint32_t v) { return mesh.is_removed(v); }) > 0)
    {
        group();
    }
}

std::span<const std::uint32_t> CutCopies::of(std::uint32_t vertex) const
{
    if (sources_.empty())
    {
        return {};
    }
    const auto found = std::ranges::lower_bound(sources_, source(vertex));
    if (found == sources_.end() || *found != source(vertex))
    {
        return {};
    }
    const auto i = static_cast<std::size_t>(found - sources_.begin());
    return std::span(copies_).subspan(first_[i], first_[i + 1] - first_[i]);
}

bool CopyStars::collect(
    const CollapseMesh& mesh,
    const CutCopies& copies,
    std::uint32_t of,
    std::uint32_t most_neighbours
)
{
    const std::span<const std::uint32_t> list = copies.of(of);
    if (list.size() > kMost)
    {
        return false;
    }
    count = 0;
    std::array<std::uint32_t, kMost * OneRing::kMost> around{};
    std::size_t size = 0;
    for (const std::uint32_t v : list)
    {
        const std::uint32_t valence = mesh.valence(v);
        if (valence < 3 || valence > most_neighbours || !mesh.ring(v, ring[count]))
        {
            return false;
        }
        const OneRing& own = ring[count];
        std::copy_n(
            own.vertex.begin(), own.size, around.begin() + static_cast<std::ptrdiff_t>(size)
        );
        size += own.size;
        vertex[count++] = v;
    }
    const auto end = around.begin() + static_cast<std::ptrdiff_t>(size);
    std::sort(around.begin(), end);
    return std::adjacent_find(around.begin(), end) == end;
}

bool CopyStars::aim_at(const CutCopies& copies, std::uint32_t target)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        const OneRing& own = ring[i];
        std::size_t found = 0;
        for (std::size_t k = 0; k < own.size; ++k)
        {
            if (copies.source(own.vertex[k]) == copies.source(target))
            {
                kept[i] = k;
                ++found;
            }
        }
        const bool along = !own.boundary || kept[i] == 0 || kept[i] + 1 == own.size;
        if (found != 1 || !along)
        {
            return false;
        }
    }
    return true;
}

}  // namespace vsplit::precompute
