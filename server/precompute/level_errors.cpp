#include "precompute/level_errors.h"

#include "precompute/error_tracker.h"

#include <algorithm>
#include <cmath>
#include <ranges>

namespace vsplit::precompute {
namespace {

/// Tolerated ratio of cell size to surface error; larger saves bits, smaller shows steps. Measured: the
/// optimum between 3 and 4 is flat at every rate.
constexpr double kCellsPerError = 3.3;

/// Below this, in grid units, a region counts as exact: cells cannot get smaller.
constexpr double kLeastRegionError = 0.1;

/// The error that decides about the precision of a level.
double telling_error(const ErrorTracker::SourceError& error)
{
    if (!error.region)
    {
        return error.whole;
    }
    // Cells made for the whole would blur the region. Measured (cow, homer, rocker-arm): the geometric
    // mean takes up to 44 % off the region's error at a given rate and adds up to 15 % to the rest's;
    // the region's own error as the measure adds up to 30 % to it.
    const double region = std::max(*error.region, kLeastRegionError);
    return std::sqrt(error.whole * std::min(error.whole, region));
}

/// Whole octaves of the tolerated cell size. Half of the bits stay, so that a small model's base does
/// not fall into a few points.
int shift_for(double rms, int bits)
{
    double cells = kCellsPerError * rms;
    int shift = 0;
    for (; cells >= 2.0 && shift < bits / 2; ++shift)
    {
        cells *= 0.5;
    }
    return shift;
}

/// Carries out the collapses that lead to a level.
void collapse(ErrorTracker& tracker, const LevelBatches& batches)
{
    for (const auto& batch : batches | std::views::reverse)
    {
        tracker.collapse(batch);
    }
}

std::vector<std::uint32_t> removed_vertices(const LevelBatches& batches)
{
    std::vector<std::uint32_t> removed;
    for (const auto& batch : batches)
    {
        for (const codec::Collapse& collapse : batch)
        {
            removed.push_back(collapse.removed);
        }
    }
    return removed;
}

/// Leaves only the triangles that have a free vertex.
void drop_fixed_triangles(PlacedLevel& level, std::vector<std::uint8_t>& is_free)
{
    for (const std::uint32_t v : level.free)
    {
        is_free[v] = 1;
    }
    std::erase_if(level.triangles, [&](const Triangle& triangle) {
        return std::ranges::none_of(triangle, [&](std::uint32_t v) { return is_free[v] != 0; });
    });
    for (const std::uint32_t v : level.free)
    {
        is_free[v] = 0;
    }
}

/// Chooses the shift of every level and finds the levels to place, coarsest first.
std::vector<PlacedLevel> choose_shifts(
    ErrorTracker& tracker,
    std::span<const LevelBatches> levels,
    const PlacementSource& source,
    std::vector<LevelError>& errors
)
{
    std::vector<PlacedLevel> placed;
    std::vector<std::uint8_t> is_free(source.exact.size(), 0);
    std::size_t vertices = source.exact.size();
    for (std::size_t i = levels.size(); i-- > 0;)
    {
        PlacedLevel level;
        level.level = i + 1;
        level.shift = errors[i + 1].shift;
        const bool worth = is_worth_placing(vertices, source.exact.size(), level.shift);
        if (worth)
        {
            level.triangles = tracker.triangles();
        }
        collapse(tracker, levels[i]);
        std::vector<std::uint32_t> removed = removed_vertices(levels[i]);
        vertices -= removed.size();
        const int shift = shift_for(telling_error(tracker.follow()), source.bits);
        errors[i].shift = std::max(level.shift, shift);
        if (worth)
        {
            if (errors[i].shift == level.shift)
            {
                level.free = std::move(removed);
                drop_fixed_triangles(level, is_free);
            }
            placed.push_back(std::move(level));
        }
    }
    if (is_worth_placing(vertices, source.exact.size(), errors.front().shift))
    {
        placed.push_back({0, errors.front().shift, tracker.triangles(), {}});
    }
    std::ranges::reverse(placed);
    return placed;
}

/// The cells that the vertices of a level are shown in, and of the coarser ones with the same shift.
std::vector<std::array<std::int32_t, 3>> shown_cells(
    const GridMesh& mesh, std::span<const LevelError> errors, std::size_t level
)
{
    const int shift = errors[level].shift;
    auto cells = mesh.positions;
    for (auto& cell : cells)
    {
        for (std::int32_t& coordinate : cell)
        {
            coordinate >>= shift;
        }
    }
    for (std::size_t i = level + 1; i-- > 0 && errors[i].shift == shift;)
    {
        for (const codec::Displacement& displacement : errors[i].displaced)
        {
            cells[displacement.vertex] = displacement.position;
        }
    }
    return cells;
}

}  // namespace

std::vector<LevelError> measure_levels(
    const PlacementSource& source,
    std::span<const LevelBatches> levels,
    std::span<const float> importance,
    unsigned threads,
    const std::function<void(double)>& progress
)
{
    ErrorTracker tracker(source.exact, *source.mesh, importance, threads);
    std::vector<LevelError> errors(levels.size() + 1);
    PlacementSource with_tree = source;
    with_tree.tree = &tracker.tree();
    const auto to_place = choose_shifts(tracker, levels, source, errors);
    auto placed = place_levels(with_tree, to_place, threads);
    for (std::size_t i = 0; i < placed.size(); ++i)
    {
        errors[to_place[i].level].displaced = std::move(placed[i]);
    }
    tracker.restart();
    auto cells = source.mesh->positions;
    errors.back().distance = tracker.measure(0, cells);
    for (std::size_t i = levels.size(); i-- > 0;)
    {
        collapse(tracker, levels[i]);
        static_cast<void>(tracker.follow());
        if (errors[i].shift != errors[i + 1].shift)
        {
            cells = shown_cells(*source.mesh, errors, i);
        }
        errors[i].distance = tracker.measure(errors[i].shift, cells);
        if (progress)
        {
            progress(1.0 - static_cast<double>(i) / static_cast<double>(levels.size()));
        }
    }
    return errors;
}

}  // namespace vsplit::precompute
