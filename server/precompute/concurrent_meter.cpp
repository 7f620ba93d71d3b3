#include "precompute/concurrent_meter.h"

#include <utility>

namespace vsplit::precompute {

ConcurrentMeter::ConcurrentMeter(
    const PlacementSource& source, std::span<const float> importance, unsigned threads
)
    : source_(source), importance_(importance), threads_(threads)
{
    if (threads > 1)
    {
        queue_ = std::make_unique<TaskQueue>();
        queue_->run([this] { meter_.emplace(source_, importance_, threads_); });
    }
}

void ConcurrentMeter::take(const LevelStep& step, bool is_level)
{
    takes_ = takes_ && is_level && queue_ != nullptr;
    if (takes_)
    {
        ++taken_;
        queue_->run([this, level = step] { meter_->add(level); });
    }
}

std::vector<LevelView> ConcurrentMeter::choose(std::span<const LevelStep> levels)
{
    if (queue_ == nullptr)
    {
        meter_.emplace(source_, importance_, threads_);
    }
    else
    {
        queue_->wait();
    }
    for (std::size_t i = levels.size() - taken_; i-- > 0;)
    {
        meter_->add(levels[i]);
    }
    return meter_->choose();
}

void ConcurrentMeter::start_measuring(
    std::span<const LevelStep> levels, std::span<const LevelView> views
)
{
    const auto measure = [this, levels, views] {
        distances_ = meter_->measure(levels, views);
        meter_.reset();
    };
    if (queue_ == nullptr)
    {
        measure();
        return;
    }
    queue_->run(measure);
}

std::vector<SurfaceDistance> ConcurrentMeter::result()
{
    if (queue_ != nullptr)
    {
        queue_->wait();
    }
    return std::move(distances_);
}

}  // namespace vsplit::precompute
