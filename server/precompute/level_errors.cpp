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

/// Carries out what leads to a level.
void coarsen(ErrorTracker& tracker, const LevelStep& level)
{
    for (const auto& batch : level.batches | std::views::reverse)
    {
        tracker.collapse(batch);
    }
    if (!level.parts.empty())
    {
        tracker.remove_parts(level.parts);
    }
}

std::vector<std::uint32_t> removed_vertices(const LevelStep& level)
{
    std::vector<std::uint32_t> removed;
    for (const std::vector<Triangle>& group : level.parts)
    {
        for (const Triangle& triangle : group)
        {
            removed.insert(removed.end(), triangle.begin(), triangle.end());
        }
    }
    std::ranges::sort(removed);
    const auto repeated = std::ranges::unique(removed);
    removed.erase(repeated.begin(), repeated.end());
    for (const auto& batch : level.batches)
    {
        for (const codec::Collapse& collapse : batch)
        {
            removed.push_back(collapse.removed);
        }
    }
    return removed;
}

/// The cells that the vertices of a level are shown in, and of the coarser ones with the same shift.
std::vector<std::array<std::int32_t, 3>> shown_cells(
    const GridMesh& mesh, std::span<const LevelView> views, std::size_t level
)
{
    const int shift = views[level].shift;
    auto cells = mesh.positions;
    for (auto& cell : cells)
    {
        for (std::int32_t& coordinate : cell)
        {
            coordinate >>= shift;
        }
    }
    for (std::size_t i = level + 1; i-- > 0 && views[i].shift == shift;)
    {
        for (const codec::Displacement& displacement : views[i].displaced)
        {
            cells[displacement.vertex] = displacement.position;
        }
    }
    return cells;
}

}  // namespace

LevelMeter::LevelMeter(
    const PlacementSource& source, std::span<const float> importance, unsigned threads
)
    : source_(source),
      threads_(threads),
      tracker_(source.exact, *source.mesh, importance, threads),
      shifts_(1, 0),
      vertices_(source.exact.size())
{
    source_.tree = &tracker_.tree();
}

void LevelMeter::add(const LevelStep& level)
{
    const int shift = std::max(shifts_.back(), source_.late_bits);
    place();
    coarsen(tracker_, level);
    const std::vector<std::uint32_t> removed = removed_vertices(level);
    vertices_ -= removed.size();
    if (!placed_.empty())
    {
        auto& born = placed_.back().born;
        born.insert(born.end(), removed.begin(), removed.end());
    }
    const double error = telling_error(tracker_.follow());
    // Components come at the precision of the level before them.
    const bool may_rise = level.parts.empty();
    shifts_.push_back(may_rise ? std::max(shift, shift_for(error, source_.bits)) : shift);
}

void LevelMeter::place()
{
    const int shift = shifts_.back();
    if (!is_worth_placing(vertices_, source_.exact.size(), shift))
    {
        return;
    }
    if (placed_.empty() || placed_.back().shift != shift)
    {
        placed_.emplace_back();
        placed_.back().shift = shift;
        placed_.back().finest = tracker_.triangles();
    }
    else
    {
        placed_.back().coarsest = tracker_.triangles();
    }
    placed_.back().coarsest_level = shifts_.size() - 1;
}

std::vector<LevelView> LevelMeter::choose()
{
    const std::size_t last = shifts_.size() - 1;
    place();
    std::ranges::reverse(placed_);
    std::vector<LevelView> views(shifts_.size());
    for (std::size_t i = 0; i < views.size(); ++i)
    {
        views[i].shift = shifts_[last - i];
    }
    auto displaced = place_levels(source_, placed_, threads_);
    for (std::size_t i = 0; i < displaced.size(); ++i)
    {
        views[last - placed_[i].coarsest_level].displaced = std::move(displaced[i]);
    }
    placed_ = {};
    return views;
}

std::vector<SurfaceDistance> LevelMeter::measure(
    std::span<const LevelStep> levels, std::span<const LevelView> views
)
{
    tracker_.restart();
    std::vector<SurfaceDistance> distances(views.size());
    auto cells = source_.mesh->positions;
    distances.back() = tracker_.measure(0, cells);
    for (std::size_t i = levels.size(); i-- > 0;)
    {
        coarsen(tracker_, levels[i]);
        static_cast<void>(tracker_.follow());
        if (views[i].shift != views[i + 1].shift)
        {
            cells = shown_cells(*source_.mesh, views, i);
        }
        distances[i] = tracker_.measure(views[i].shift, cells);
    }
    return distances;
}

}  // namespace vsplit::precompute
