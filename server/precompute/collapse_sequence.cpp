#include "precompute/collapse_sequence.h"

#include "precompute/attribute_cost.h"
#include "precompute/collapse_cost.h"
#include "precompute/collapse_mesh.h"
#include "precompute/level_builder.h"
#include "precompute/level_schedule.h"

#include <algorithm>
#include <utility>

namespace vsplit::precompute {
namespace {

/// Levels that make less progress than this end the sequence, unless there are but a few vertices.
constexpr double kLeastShare = 0.02;
constexpr std::size_t kFewVertices = 400;

/// Splits that a level has at most when it joins several batches.
constexpr std::size_t kSmallestLevel = 30;

/// The same by its vertices, for small meshes with attributes: a level costs nine bytes for these alone.
constexpr double kSmallestShare = 0.6;
constexpr std::size_t kSmallMesh = 8000;

bool joins_more(const Source& source)
{
    return !source.wedges.empty() && source.exact.size() < kSmallMesh;
}

/// Vertices at which the collapses from a mesh of `vertices` out of `all` stop next.
std::size_t next_goal(
    const EncodeOptions& options, const PartSchedule& parts, std::size_t vertices, std::size_t all
)
{
    const std::size_t stop = next_stop(options, vertices, all);
    return options.base_vertices != 0 ? stop : parts.base_goal(stop);
}

/// Carries the sequence out and keeps it.
class SequenceMaker
{
public:
    SequenceMaker(Source& source, const EncodeOptions& options, PartSchedule& parts)
        : options_(options),
          parts_(parts),
          vertex_count_(source.exact.size()),
          joins_more_(joins_more(source)),
          working_(
              static_cast<std::uint32_t>(vertex_count_), source.quantised.triangles, source.wedges
          ),
          cost_(
              options.metric, source.exact, working_, std::move(source.weights), source.importance
          ),
          attributes_(
              working_, source.exact, {source.attributes, source.values}, options.attribute_weight
          ),
          builder_(working_, cost_, source.exact, {}, options.threads)
    {
        cost_.count_attributes(attributes_);
        builder_.fold_together(source.stitches);
    }

    Sequence run(const ProgressSink& progress, const StepSink& take_step)
    {
        const std::size_t base = next_goal(options_, parts_, 0, vertex_count_);
        if (late_bits(options_) > 0)
        {
            add_step({{{}}, {}}, true, take_step);
            sequence_.seams.emplace_back();
        }
        bool choosy = true;
        while (builder_.vertex_count() > base)
        {
            const bool slow = fold(choosy, take_step);
            if (progress)
            {
                const auto left = static_cast<double>(builder_.vertex_count());
                progress("collapse", 1.0 - left / static_cast<double>(vertex_count_));
            }
            auto removed = parts_.take(working_, builder_.vertex_count(), base, slow);
            if (!removed.empty())
            {
                builder_.forget_removed();
                add_step({{}, std::move(removed)}, true, take_step);
                continue;
            }
            if (slow && (!choosy || parts_.is_base(builder_.vertex_count())))
            {
                break;
            }
            // Where topology holds the cheap ones back, others must do.
            choosy = choosy && !slow;
        }
        sequence_.base = working_.triangles();
        return std::move(sequence_);
    }

private:
    /// Makes one batch. Result: true when it made little progress.
    bool fold(bool choosy, const StepSink& take_step)
    {
        const std::size_t before = builder_.vertex_count();
        const std::size_t stop = next_goal(options_, parts_, before, vertex_count_);
        LevelStyle style = style_for(options_.metric, before, vertex_count_);
        style.cheapest_share = choosy ? style.cheapest_share : 1.0;
        auto level = builder_.next_level(style, before - stop);
        const bool arrived = before - level.size() == stop;
        const double least =
            before > kFewVertices ? kLeastShare * static_cast<double>(before) : 1.0;
        const bool slow = !arrived && static_cast<double>(level.size()) < least;
        if (!level.empty())
        {
            add_step({{std::move(level)}, {}}, arrived, take_step);
            sequence_.seams.push_back(builder_.take_seams());
        }
        return slow;
    }

    void add_step(LevelStep step, bool starts, const StepSink& take_step)
    {
        const bool is_level = !step.parts.empty() || step.batches.front().empty() ||
                              step.batches.front().size() > kSmallestLevel;
        take_step(step, is_level && !joins_more_);
        sequence_.levels.push_back(std::move(step));
        sequence_.starts.push_back(starts ? 1 : 0);
    }

    const EncodeOptions& options_;
    PartSchedule& parts_;
    std::size_t vertex_count_;
    bool joins_more_;
    CollapseMesh working_;
    CollapseCost cost_;
    AttributeCost attributes_;
    LevelBuilder builder_;
    Sequence sequence_;
};

}  // namespace

Sequence make_sequence(
    Source& source,
    const EncodeOptions& options,
    const ProgressSink& progress,
    PartSchedule& parts,
    const StepSink& take_step
)
{
    return SequenceMaker(source, options, parts).run(progress, take_step);
}

void order_levels(Sequence& sequence, const Source& source)
{
    std::size_t vertices = source.exact.size();
    for (const LevelStep& step : sequence.levels)
    {
        vertices -= step.batches.empty() ? 0 : step.batches.front().size();
    }
    std::vector<LevelStep> joined;
    std::size_t splits = 0;
    std::size_t most = 0;
    for (std::size_t i = sequence.levels.size(); i-- > 0;)
    {
        if (!sequence.levels[i].parts.empty())
        {
            most = 0;
            joined.push_back(std::move(sequence.levels[i]));
            continue;
        }
        auto& batch = sequence.levels[i].batches.front();
        if (splits + batch.size() > most || sequence.starts[i] != 0 ||
            joined.back().batches.size() == codec::kMaxBatches)
        {
            const auto share =
                static_cast<std::size_t>(static_cast<double>(vertices) * kSmallestShare);
            splits = 0;
            most = joins_more(source) ? std::max(kSmallestLevel, share) : kSmallestLevel;
            joined.emplace_back();
        }
        splits += batch.size();
        vertices += batch.size();
        joined.back().batches.push_back(std::move(batch));
    }
    sequence.levels = std::move(joined);
}

}  // namespace vsplit::precompute
