// Based on: Popović, Hoppe, "Progressive Simplicial Complexes", 1997 (what hangs together in an edge is
// contracted together); Guéziec, Taubin, Lazarus, Horn, "Cutting and Stitching: Converting Sets of
// Polygons to Manifold Surfaces", 2001 (copies of cut vertices).
#include "precompute/level_builder.h"

#include <algorithm>
#include <array>

namespace vsplit::precompute {

void LevelBuilder::collect_copies(std::uint32_t first, const LevelStyle& style)
{
    const std::span<Candidate> candidates = candidates_of(first);
    std::ranges::fill(candidates, Candidate{});
    CopyStars stars;
    if (!stars.collect(mesh_, copies_, first, kMostNeighbours))
    {
        return;
    }
    std::array<std::array<Candidate, kMostNeighbours>, CopyStars::kMost> rated{};
    for (std::size_t i = 0; i < stars.count; ++i)
    {
        rate(stars.vertex[i], stars.ring[i], style, rated[i]);
    }
    const auto share = 1.0F / static_cast<float>(stars.count);
    for (std::size_t kept = 0; kept < candidates.size(); ++kept)
    {
        if (!stars.aim_at(copies_, stars.ring[0].vertex[kept]))
        {
            continue;
        }
        // What each costs on the average: as many vertices go.
        candidates[kept] = {0.0F, 0.0F};
        for (std::size_t i = 0; i < stars.count; ++i)
        {
            candidates[kept].price += share * rated[i][stars.kept[i]].price;
            candidates[kept].key += share * rated[i][stars.kept[i]].key;
        }
    }
}

bool LevelBuilder::try_copies(
    std::uint32_t first, const LevelStyle& style, std::vector<codec::Collapse>& done
)
{
    CopyStars stars;
    if (!stars.collect(mesh_, copies_, first, kMostNeighbours) ||
        done.size() + stars.count > limit_)
    {
        return false;
    }
    const std::span<const Candidate> candidates = candidates_of(first);
    std::array<std::pair<float, std::size_t>, kMostNeighbours> choices{};
    for (std::size_t kept = 0; kept < candidates.size(); ++kept)
    {
        choices[kept] = {candidates[kept].key, kept};
    }
    const auto end = choices.begin() + static_cast<std::ptrdiff_t>(candidates.size());
    std::sort(choices.begin(), end);
    for (std::size_t i = 0; i < candidates.size() && choices[i].first < kSettled; ++i)
    {
        bool fits = stars.aim_at(copies_, stars.ring[0].vertex[choices[i].second]);
        for (std::size_t c = 0; c < stars.count; ++c)
        {
            // The first one has just been taken from the heap.
            fits = fits && (stars.vertex[c] == first || best_key_[stars.vertex[c]] < kSettled) &&
                   mesh_.can_collapse(stars.vertex[c], stars.ring[c], stars.kept[c], kValenceLimit);
        }
        if (!fits)
        {
            continue;
        }
        // Their rings have no vertex in common, so that what holds for one now holds after the others.
        for (std::size_t c = 0; c < stars.count; ++c)
        {
            carry_out(stars.vertex[c], stars.ring[c], stars.kept[c], style, done);
            best_key_[stars.vertex[c]] = kSettled;
        }
        return true;
    }
    return false;
}

}  // namespace vsplit::precompute
