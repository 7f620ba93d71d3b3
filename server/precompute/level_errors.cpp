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

}  // namespace

std::vector<LevelError> measure_levels(
    std::span<const Vector3> exact,
    const GridMesh& mesh,
    std::span<const LevelBatches> levels,
    std::span<const float> importance,
    int bits,
    unsigned threads,
    const std::function<void(double)>& progress
)
{
    ErrorTracker tracker(exact, mesh, importance, threads);
    std::vector<LevelError> errors(levels.size() + 1);
    errors.back().distance = tracker.measure(0);
    for (std::size_t i = levels.size(); i-- > 0;)
    {
        for (const auto& batch : levels[i] | std::views::reverse)
        {
            tracker.collapse(batch);
        }
        const int shift = shift_for(telling_error(tracker.follow()), bits);
        errors[i].shift = std::max(errors[i + 1].shift, shift);
        errors[i].distance = tracker.measure(errors[i].shift);
        if (progress)
        {
            progress(1.0 - static_cast<double>(i) / static_cast<double>(levels.size()));
        }
    }
    return errors;
}

}  // namespace vsplit::precompute
