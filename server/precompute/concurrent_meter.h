#pragma once

#include "precompute/level_errors.h"
#include "precompute/task_queue.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Lets a LevelMeter follow the collapses while they are chosen, and measure while the stream is coded,
/// if there are threads for that; else it does all in one go when it is asked. The results are the same.
/// For one thread only.
class ConcurrentMeter
{
public:
    /// As LevelMeter, which is made as late as `threads` allows.
    ConcurrentMeter(
        const PlacementSource& source, std::span<const float> importance, unsigned threads
    );

    /// Takes the next batch, finest first, if it is a level of its own; after one that is not, batches
    /// are left to choose().
    void take(const LevelStep& step, bool is_level);

    /// Tells how levels are shown. `levels`: all of them, coarsest first.
    [[nodiscard]] std::vector<LevelView> choose(std::span<const LevelStep> levels);

    /// Starts to measure; `levels` and `views` must stay as they are until result() returns.
    void start_measuring(std::span<const LevelStep> levels, std::span<const LevelView> views);

    /// Returns what LevelMeter::measure() found.
    [[nodiscard]] std::vector<SurfaceDistance> result();

private:
    PlacementSource source_;
    std::span<const float> importance_;
    unsigned threads_;
    std::optional<LevelMeter> meter_;
    std::vector<SurfaceDistance> distances_;
    std::size_t taken_ = 0;
    bool takes_ = true;
    std::unique_ptr<TaskQueue> queue_;  ///< None with one thread. Last: its tasks use the others.
};

}  // namespace vsplit::precompute
