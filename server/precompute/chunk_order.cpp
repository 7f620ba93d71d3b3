// Based on: Shoham and Gersho, "Efficient Bit Allocation for an Arbitrary Set of Quantizers", 1988: the
// sequence with the steepest fall of the error per byte goes next. Geometry against texture by the error of
// pictures: Balmelli, "Rate-Distortion Optimal Mesh Simplification for Communications", 2001, and
// Tian and AlRegib, "BaTex3: Bit Allocation for Progressive Transmission of Textured 3-D Models", 2008.
#include "precompute/chunk_order.h"

#include "core/assert.h"
#include "precompute/order_pictures.h"

#include <algorithm>
#include <optional>

namespace vsplit::precompute {
namespace {

/// Runs of one sequence that are looked at before one of them is taken.
constexpr std::size_t kLookAhead = 4;

/// Stages of the shape, or the chunks of an image: states 0 .. size, each longer than the one before.
struct Sequence
{
    std::vector<std::uint64_t> ends;  ///< By state the bytes up to it.
    std::vector<std::uint32_t>
        knots;             ///< States that are looked at, ascending; the first one is 0.
    std::size_t next = 1;  ///< Index of the next knot.
};

/// Picks `count` states, evenly by the logarithm of their bytes: each about as many times longer.
std::vector<std::uint32_t> pick_knots(const std::vector<std::uint64_t>& ends, std::size_t count)
{
    const auto last = static_cast<std::uint32_t>(ends.size() - 1);
    if (ends.size() <= count + 1)
    {
        std::vector<std::uint32_t> all(ends.size());
        for (std::uint32_t i = 0; i <= last; ++i)
        {
            all[i] = i;
        }
        return all;
    }
    // The smallest ratio that gives no more than `count`; ratios grow by steps of a hundredth.
    std::vector<std::uint32_t> knots;
    for (double ratio = 1.05; knots.empty() || knots.size() > count + 1; ratio *= 1.01)
    {
        knots = {0};
        for (std::uint32_t i = 1; i < last; ++i)
        {
            const auto start = static_cast<double>(std::max<std::uint64_t>(ends[knots.back()], 1));
            if (knots.size() == 1 || static_cast<double>(ends[i]) >= ratio * start)
            {
                knots.push_back(i);
            }
        }
        knots.push_back(last);
    }
    return knots;
}

std::vector<Sequence> make_sequences(const OrderSource& source, const OrderOptions& options)
{
    std::vector<Sequence> sequences(1 + source.texture_bytes.size());
    std::uint64_t end = 0;
    for (const std::uint64_t bytes : source.stage_bytes)
    {
        sequences[0].ends.push_back(end += bytes);
    }
    for (std::size_t i = 0; i < source.texture_bytes.size(); ++i)
    {
        sequences[i + 1].ends.push_back(end = 0);
        for (const std::uint64_t bytes : source.texture_bytes[i])
        {
            sequences[i + 1].ends.push_back(end += bytes);
        }
    }
    // Half of the states for the shape, the other for the images.
    const std::size_t images = std::max<std::size_t>(source.texture_bytes.size(), 1);
    for (std::size_t s = 0; s < sequences.size(); ++s)
    {
        const std::size_t share = options.most_states / (s == 0 ? 2 : 2 * images);
        sequences[s].knots = pick_knots(sequences[s].ends, std::max<std::size_t>(share, 2));
    }
    return sequences;
}

/// Finds an order, one run of steps between two knots after the other.
class Orderer
{
public:
    Orderer(const OrderSource& source, const OrderOptions& options)
        : options_(options),
          pictures_(source, options),
          sequences_(make_sequences(source, options)),
          state_(sequences_.size(), 0)
    {
    }

    Result<ChunkOrder> run()
    {
        const auto first = pictures_.error(state_);
        VSPLIT_TRY(first);
        error_ = *first;
        order_.steps.push_back({OrderStep::kGeometry, 0, sequences_[0].ends.front(), error_, true});
        for (;;)
        {
            const auto best = choose();
            VSPLIT_TRY(best);
            if (!*best)
            {
                return std::move(order_);
            }
            take(**best);
        }
    }

private:
    /// What is known after a run of steps.
    struct Measured
    {
        std::uint32_t state = 0;  ///< Of the sequence, after it.
        double error = 0.0;
    };

    /// Runs of one sequence that may come next.
    struct Candidate
    {
        std::size_t sequence = 0;
        double slope = 0.0;          ///< Fall of the error per byte over all of them.
        std::vector<Measured> runs;  ///< Empty: one run that was not measured.
    };

    Result<std::optional<Candidate>> choose()
    {
        std::optional<Candidate> best;
        for (std::size_t s = 0; s < sequences_.size(); ++s)
        {
            if (sequences_[s].next == sequences_[s].knots.size())
            {
                continue;
            }
            auto candidate = consider(s);
            VSPLIT_TRY(candidate);
            if (!best || candidate->slope > best->slope)
            {
                best = std::move(*candidate);
            }
        }
        return best;
    }

    /// The next runs of a sequence up to where the error falls less for their bytes than before: a preview that is not
    /// yet better than nothing, or a level that needs the next one to shine, would keep back all that follows.
    Result<Candidate> consider(std::size_t s)
    {
        const Sequence& sequence = sequences_[s];
        Candidate best{s, 0.0, {}};
        std::vector<Measured> runs;
        for (std::size_t ahead = 0; ahead < kLookAhead; ++ahead)
        {
            const std::size_t knot = sequence.next + ahead;
            if (knot == sequence.knots.size())
            {
                break;
            }
            OrderState state = state_;
            state[s] = sequence.knots[knot];
            if (!pictures_.is_known(state) && pictures_.drawn_states() >= options_.most_pictures)
            {
                break;
            }
            const auto error = pictures_.error(state);
            VSPLIT_TRY(error);
            runs.push_back({state[s], *error});
            const std::uint64_t bytes = sequence.ends[state[s]] - sequence.ends[state_[s]];
            const double slope =
                (error_ - *error) / static_cast<double>(std::max<std::uint64_t>(bytes, 1));
            if (best.runs.empty() || slope > best.slope)
            {
                best.slope = slope;
                best.runs = runs;
            }
            else if (best.slope > 0.0)
            {
                break;
            }
        }
        if (best.runs.empty())
        {
            best.slope = guess_slope(s);
        }
        return best;
    }

    /// Without a picture: the error falls as one over the bytes.
    [[nodiscard]] double guess_slope(std::size_t s) const
    {
        const Sequence& sequence = sequences_[s];
        return error_ / static_cast<double>(sequence.ends[sequence.knots[sequence.next]] + 1);
    }

    void take(const Candidate& chosen)
    {
        if (chosen.runs.empty())
        {
            const Sequence& sequence = sequences_[chosen.sequence];
            take_run(chosen.sequence, {sequence.knots[sequence.next], error_}, false);
        }
        for (const Measured& run : chosen.runs)
        {
            take_run(chosen.sequence, run, true);
        }
    }

    void take_run(std::size_t s, const Measured& run, bool measured)
    {
        Sequence& sequence = sequences_[s];
        const std::uint32_t from = state_[s];
        const auto all = static_cast<double>(sequence.ends[run.state] - sequence.ends[from]);
        for (std::uint32_t i = from + 1; i <= run.state; ++i)
        {
            OrderStep step;
            step.image = static_cast<std::int32_t>(s) - 1;
            step.index = s == 0 ? i : i - 1;
            step.bytes = sequence.ends[i] - sequence.ends[i - 1];
            const auto done = static_cast<double>(sequence.ends[i] - sequence.ends[from]);
            const double share = all > 0.0 ? done / all : 1.0;
            step.error = error_ + share * (run.error - error_);
            step.measured = i == run.state && measured;
            order_.steps.push_back(step);
        }
        state_[s] = run.state;
        error_ = run.error;
        ++sequence.next;
    }

    const OrderOptions& options_;
    OrderPictures pictures_;
    std::vector<Sequence> sequences_;
    OrderState state_;
    double error_ = 0.0;
    ChunkOrder order_;
};

}  // namespace

std::uint32_t ChunkOrder::stage_before(std::uint32_t image, std::uint32_t chunk) const
{
    std::uint32_t stage = 0;
    for (const OrderStep& step : steps)
    {
        if (step.image == OrderStep::kGeometry)
        {
            stage = step.index;
        }
        else if (static_cast<std::uint32_t>(step.image) == image && step.index == chunk)
        {
            return stage;
        }
    }
    VSPLIT_ASSERT(false);
    return stage;
}

Result<ChunkOrder> order_chunks(const OrderSource& source, const OrderOptions& options)
{
    VSPLIT_ASSERT(source.original != nullptr && source.appearance != nullptr);
    VSPLIT_ASSERT(!source.stage_bytes.empty());
    VSPLIT_ASSERT(source.original_images.size() >= source.texture_bytes.size());
    return Orderer(source, options).run();
}

}  // namespace vsplit::precompute
