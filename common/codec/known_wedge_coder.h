#pragma once

#include "codec/attribute_state.h"
#include "codec/level_mesh.h"
#include "codec/wedge_work.h"
#include "core/result.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Codes where a vertex of the level before has its wedges, which are known, when it has several. Not
/// thread safe. Safe on untrusted input.
template <typename Coder>
class KnownWedgeCoder
{
public:
    /// `work`: must outlive this.
    explicit KnownWedgeCoder(WedgeWork<Coder>& work) : work_(work) {}

    /// Codes the corners of a vertex whose wedges are known but not where they are.
    [[nodiscard]] Result<void> code(std::uint32_t vertex)
    {
        if (work_.is_single(vertex))
        {
            return {};
        }
        list_wedges(vertex);
        walk_fan(work_.mesh, work_.first[vertex], fan_);
        start_at_known();
        const std::size_t size = fan_.corners.size();
        for (std::size_t i = 0; i < size; ++i)
        {
            const Corner corner = fan_.corners[i];
            if (work_.wedge_at(corner) == kNoWedge)
            {
                const auto wedge = i == 0 ? code_any(corner) : code_next(i);
                VSPLIT_TRY(wedge);
                work_.wedge_at(corner) = *wedge;
            }
        }
        for (std::size_t i = 0; i < (fan_.closed ? size : size - 1); ++i)
        {
            if (work_.wedge_at(fan_.corners[i]) != work_.wedge_at(fan_.corners[(i + 1) % size]))
            {
                work_.go_on_at(work_.mesh.vertex(previous_corner(fan_.corners[i])));
            }
        }
        return {};
    }

private:
    void list_wedges(std::uint32_t vertex)
    {
        own_.clear();
        for (std::uint32_t w = work_.state.first_wedge[vertex]; w != kNoWedge;)
        {
            own_.push_back(w);
            w = work_.state.next_wedge[w];
        }
    }

    /// Turns a closed fan so that it begins with what is known best.
    void start_at_known()
    {
        auto& corners = fan_.corners;
        auto start =
            std::ranges::find_if(corners, [&](Corner c) { return work_.wedge_at(c) != kNoWedge; });
        if (start == corners.end())
        {
            start = std::ranges::find_if(corners, [&](Corner c) {
                return work_.wedge_at(next_corner(c)) != kNoWedge ||
                       work_.wedge_at(previous_corner(c)) != kNoWedge;
            });
        }
        if (fan_.closed && start != corners.end())
        {
            std::rotate(corners.begin(), start, corners.end());
        }
    }

    /// The wedge of the vertex whose values are nearest to those of the corner's known neighbours; kNoWedge
    /// when none is known.
    [[nodiscard]] std::uint32_t likely_wedge(Corner corner)
    {
        std::uint32_t best = kNoWedge;
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (const std::uint32_t w : std::span(own_).first(std::min(own_.size(), kMostCompared)))
        {
            std::int64_t sum = -1;
            for (const Corner beside : {next_corner(corner), previous_corner(corner)})
            {
                const std::uint32_t other = work_.wedge_at(beside);
                sum = other == kNoWedge ? sum : std::max<std::int64_t>(sum, 0) + gap(w, other);
            }
            if (sum >= 0 && sum < least)
            {
                least = sum;
                best = w;
            }
        }
        return best;
    }

    /// Difference of the values of two wedges; wedges of this level have none yet.
    [[nodiscard]] std::int64_t gap(std::uint32_t a, std::uint32_t b) const
    {
        std::int64_t sum = 0;
        for (const auto& values : work_.state.shown.values)
        {
            const std::size_t numbers = valued_wedges_ == 0 ? 0 : values.size() / valued_wedges_;
            if (std::max(a, b) >= valued_wedges_)
            {
                continue;
            }
            for (std::size_t k = 0; k < numbers; ++k)
            {
                sum += std::abs(values[a * numbers + k] - values[b * numbers + k]);
            }
        }
        return sum;
    }

    /// Codes one of a vertex's wedges of which only the neighbours tell.
    [[nodiscard]] Result<std::uint32_t> code_any(Corner corner)
    {
        const std::uint32_t likely = likely_wedge(corner);
        return code_choice(corner, likely == kNoWedge ? own_.front() : likely);
    }

    /// Codes the wedge of a corner, knowing that of the one before it in the fan.
    [[nodiscard]] Result<std::uint32_t> code_next(std::size_t i)
    {
        const Corner corner = fan_.corners[i];
        const std::uint32_t before = work_.wedge_at(fan_.corners[i - 1]);
        const std::uint32_t likely = likely_wedge(corner);
        const bool last = i + 1 == fan_.corners.size();
        const bool ends = last && !fan_.closed;
        const std::uint32_t behind =
            ends ? kNoWedge : work_.wedge_at(fan_.corners[last ? 0 : i + 1]);
        const std::size_t context =
            static_cast<std::size_t>(work_.far_end(fan_.corners[i - 1])) * 6 +
            (likely == kNoWedge ? 0U
             : likely == before ? 1U
                                : 2U) *
                2 +
            (behind != kNoWedge && behind != before ? 1U : 0U);
        const bool same = code_bit(
            work_.coder,
            work_.state.wedge_model.same[context],
            Coder::kEncodes && work_.wanted(corner) == before
        );
        if (same)
        {
            return before;
        }
        if (likely == kNoWedge || likely == before)
        {
            const std::uint32_t next = work_.state.next_wedge[before];
            return code_choice(corner, next == kNoWedge ? own_.front() : next);
        }
        return code_choice(corner, likely);
    }

    /// Codes a wedge of the vertex: the likely one, or any.
    [[nodiscard]] Result<std::uint32_t> code_choice(Corner corner, std::uint32_t likely)
    {
        const std::uint32_t wish = work_.wanted(corner);
        if (code_bit(work_.coder, work_.state.wedge_model.follows, wish == likely))
        {
            return likely;
        }
        std::uint32_t index = 0;
        if constexpr (Coder::kEncodes)
        {
            const auto found = std::ranges::find(own_, wish);
            if (found == own_.end())
            {
                return fail(ErrorCode::Internal, "a vertex gets a wedge that it had not");
            }
            index = static_cast<std::uint32_t>(found - own_.begin());
        }
        index = work_.coder.raw(index, static_cast<int>(std::bit_width(own_.size() - 1)));
        return own_[std::min<std::size_t>(index, own_.size() - 1)];
    }

    /// Wedges of a vertex that are compared with the neighbours; bounds what a hostile stream can ask for.
    static constexpr std::size_t kMostCompared = 64;

    WedgeWork<Coder>& work_;
    std::size_t valued_wedges_ = work_.state.shown.wedge_vertices.size();
    Fan fan_;
    std::vector<std::uint32_t> own_;  ///< Wedges of the vertex.
};

}  // namespace vsplit::codec
