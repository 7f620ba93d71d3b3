#pragma once

// Based on: Isenburg, Snoeyink, "Compressing Texture Coordinates with Selective Linear Predictions", 2003
// (seams told vertex by vertex); Hoppe, "Efficient Implementation of Progressive Meshes", 1998, section 3
// (wedges). Seams are followed along their course. Encoder and decoder run this same code.

#include "codec/attribute_state.h"
#include "codec/level_mesh.h"
#include "core/result.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

namespace vsplit::codec {

/// What an encoder wants: which wedge of the source is at every corner of the level.
struct WedgeSource
{
    std::vector<Triangle> labels;  ///< By slot the source's wedges.
    std::vector<std::uint32_t>
        number_of;  ///< By source wedge its number in the stream, or kNoWedge.
    std::vector<std::uint32_t> label_of;  ///< By wedge of the stream that of the source.
};

/// Codes which corners of a level share a wedge. Not thread safe. Safe on untrusted input.
template <typename Coder>
class WedgeCoder
{
public:
    /// `mesh`: the level's; `state`: after the level before, changed by run(); `replaced`: the triangles
    /// have nothing to do with those of the level before; `source`: encoder only.
    WedgeCoder(
        Coder& coder,
        const LevelMesh& mesh,
        AttributeState& state,
        bool replaced,
        WedgeSource* source
    )
        : coder_(coder),
          mesh_(mesh),
          state_(state),
          first_(first_corners(mesh)),
          replaced_(replaced),
          source_(source),
          old_(static_cast<std::uint32_t>(state.first_wedge.size())),
          wedges_(mesh.triangles.size(), {kNoWedge, kNoWedge, kNoWedge})
    {
        state_.first_wedge.resize(mesh.positions.size(), kNoWedge);
    }

    /// Codes the level. Error: Internal when what is wanted contradicts the level before.
    [[nodiscard]] Result<void> run()
    {
        keep_known();
        if (coder_.raw(Coder::kEncodes && has_seams() ? 1 : 0, 1) == 0)
        {
            return fill_without_seams();
        }
        for (std::uint32_t v = 0; v < old_; ++v)
        {
            VSPLIT_TRY(code_old(v));
        }
        VSPLIT_TRY(follow_seams());
        for (std::uint32_t v = old_; v < state_.first_wedge.size(); ++v)
        {
            VSPLIT_TRY(code_new(v));
            VSPLIT_TRY(follow_seams());
        }
        state_.shown.wedges = std::move(wedges_);
        return {};
    }

private:
    /// What is known at the far end of an edge: whether it separates wedges there.
    enum class FarEnd : std::uint8_t
    {
        Joins,
        Separates,
        Unknown,
    };

    std::uint32_t& wedge_at(Corner corner)
    {
        return wedges_[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    }

    [[nodiscard]] std::uint32_t label_at(Corner corner) const
    {
        return source_
            ->labels[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    }

    [[nodiscard]] bool is_single(std::uint32_t vertex) const
    {
        return state_.next_wedge[state_.first_wedge[vertex]] == kNoWedge;
    }

    /// Takes over what the level before tells: corners that stay, and vertices with one wedge.
    void keep_known()
    {
        const auto& before = state_.shown.wedges;
        for (std::size_t slot = 0; slot < wedges_.size(); ++slot)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::uint32_t vertex = mesh_.triangles[slot][k];
                if (vertex >= old_)
                {
                    continue;
                }
                const bool stays = !replaced_ && slot < before.size() &&
                                   state_.shown.wedge_vertices[before[slot][k]] == vertex;
                if (stays || is_single(vertex))
                {
                    wedges_[slot][k] = stays ? before[slot][k] : state_.first_wedge[vertex];
                }
            }
        }
    }

    [[nodiscard]] bool has_seams()
    {
        for (std::uint32_t v = 0; v < state_.first_wedge.size(); ++v)
        {
            if (v < old_ ? !is_single(v) : has_breaks(v))
            {
                return true;
            }
        }
        return false;
    }

    /// Encoder only: whether a new vertex has several wedges.
    [[nodiscard]] bool has_breaks(std::uint32_t vertex)
    {
        walk_fan(mesh_, first_[vertex], fan_);
        const std::uint32_t label = label_at(fan_.corners.front());
        return std::ranges::any_of(fan_.corners, [&](Corner c) { return label_at(c) != label; });
    }

    [[nodiscard]] Result<void> fill_without_seams()
    {
        for (std::uint32_t v = old_; v < state_.first_wedge.size(); ++v)
        {
            add_wedge(v, first_[v]);
        }
        for (std::size_t slot = 0; slot < wedges_.size(); ++slot)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                if (wedges_[slot][k] == kNoWedge)
                {
                    wedges_[slot][k] = state_.first_wedge[mesh_.triangles[slot][k]];
                }
            }
        }
        state_.shown.wedges = std::move(wedges_);
        return {};
    }

    /// Appends a wedge to those of a vertex. `corner`: one that has it.
    std::uint32_t add_wedge(std::uint32_t vertex, [[maybe_unused]] Corner corner)
    {
        const auto wedge = static_cast<std::uint32_t>(state_.shown.wedge_vertices.size());
        state_.shown.wedge_vertices.push_back(vertex);
        state_.next_wedge.push_back(kNoWedge);
        std::uint32_t* link = &state_.first_wedge[vertex];
        while (*link != kNoWedge)
        {
            link = &state_.next_wedge[*link];
        }
        *link = wedge;
        if constexpr (Coder::kEncodes)
        {
            source_->number_of[label_at(corner)] = wedge;
            source_->label_of.push_back(label_at(corner));
        }
        return wedge;
    }

    /// Looks at the edge between a corner of the fan and the next one, at its far end.
    [[nodiscard]] FarEnd far_end(Corner corner)
    {
        const std::uint32_t here = wedge_at(previous_corner(corner));
        const std::uint32_t there = wedge_at(previous_corner(mesh_.across(next_corner(corner))));
        if (here == kNoWedge || there == kNoWedge)
        {
            return FarEnd::Unknown;
        }
        return here == there ? FarEnd::Joins : FarEnd::Separates;
    }

    /// Puts the vertex at the far end of a seam's edge on the list, unless it is known.
    void go_on_at(std::uint32_t vertex)
    {
        if (vertex >= old_ && state_.first_wedge[vertex] == kNoWedge)
        {
            waiting_.push_back(vertex);
        }
    }

    [[nodiscard]] Result<void> follow_seams()
    {
        while (!waiting_.empty())
        {
            const std::uint32_t vertex = waiting_.back();
            waiting_.pop_back();
            VSPLIT_TRY(code_new(vertex));
        }
        return {};
    }

    // ---- vertices of the level before ----

    /// Codes the corners of a vertex whose wedges are known but not where they are.
    [[nodiscard]] Result<void> code_old(std::uint32_t vertex)
    {
        if (is_single(vertex))
        {
            return {};
        }
        walk_fan(mesh_, first_[vertex], fan_);
        start_at_known();
        const std::size_t size = fan_.corners.size();
        for (std::size_t i = 0; i < size; ++i)
        {
            const Corner corner = fan_.corners[i];
            if (wedge_at(corner) == kNoWedge)
            {
                const auto wedge = i == 0 ? code_any(vertex, corner) : code_next(vertex, i);
                VSPLIT_TRY(wedge);
                wedge_at(corner) = *wedge;
            }
        }
        for (std::size_t i = 0; i < (fan_.closed ? size : size - 1); ++i)
        {
            if (wedge_at(fan_.corners[i]) != wedge_at(fan_.corners[(i + 1) % size]))
            {
                go_on_at(mesh_.vertex(previous_corner(fan_.corners[i])));
            }
        }
        return {};
    }

    /// Turns a closed fan so that it begins with what is known best.
    void start_at_known()
    {
        auto& corners = fan_.corners;
        auto start =
            std::ranges::find_if(corners, [&](Corner c) { return wedge_at(c) != kNoWedge; });
        if (start == corners.end())
        {
            start = std::ranges::find_if(corners, [&](Corner c) {
                return wedge_at(next_corner(c)) != kNoWedge ||
                       wedge_at(previous_corner(c)) != kNoWedge;
            });
        }
        if (fan_.closed && start != corners.end())
        {
            std::ranges::rotate(corners, start);
        }
    }

    /// The wedge of a vertex whose values are nearest to those of the corner's known neighbours; kNoWedge
    /// when none is known.
    [[nodiscard]] std::uint32_t likely_wedge(std::uint32_t vertex, Corner corner)
    {
        std::uint32_t best = kNoWedge;
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (std::uint32_t w = state_.first_wedge[vertex]; w != kNoWedge; w = state_.next_wedge[w])
        {
            std::int64_t sum = -1;
            for (const Corner beside : {next_corner(corner), previous_corner(corner)})
            {
                const std::uint32_t other = wedge_at(beside);
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
        for (const auto& values : state_.shown.values)
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
    [[nodiscard]] Result<std::uint32_t> code_any(std::uint32_t vertex, Corner corner)
    {
        const std::uint32_t likely = likely_wedge(vertex, corner);
        const std::uint32_t first = likely == kNoWedge ? state_.first_wedge[vertex] : likely;
        return code_choice(vertex, corner, first);
    }

    /// Codes the wedge of a corner, knowing that of the one before it in the fan.
    [[nodiscard]] Result<std::uint32_t> code_next(std::uint32_t vertex, std::size_t i)
    {
        const Corner corner = fan_.corners[i];
        const std::uint32_t before = wedge_at(fan_.corners[i - 1]);
        const std::uint32_t likely = likely_wedge(vertex, corner);
        const bool last = i + 1 == fan_.corners.size();
        const bool ends = last && !fan_.closed;
        const std::uint32_t behind = ends ? kNoWedge : wedge_at(fan_.corners[last ? 0 : i + 1]);
        const std::size_t context = static_cast<std::size_t>(far_end(fan_.corners[i - 1])) * 6 +
                                    (likely == kNoWedge ? 0U
                                     : likely == before ? 1U
                                                        : 2U) *
                                        2 +
                                    (behind != kNoWedge && behind != before ? 1U : 0U);
        const bool same = code_bit(
            coder_, state_.wedge_model.same[context], Coder::kEncodes && wanted(corner) == before
        );
        if (same)
        {
            return before;
        }
        if (likely == kNoWedge || likely == before)
        {
            const std::uint32_t next = state_.next_wedge[before];
            return code_choice(
                vertex, corner, next == kNoWedge ? state_.first_wedge[vertex] : next
            );
        }
        return code_choice(vertex, corner, likely);
    }

    /// Encoder only: number of the wedge at a corner.
    [[nodiscard]] std::uint32_t wanted(Corner corner) const
    {
        if constexpr (Coder::kEncodes)
        {
            return source_->number_of[label_at(corner)];
        }
        return kNoWedge;
    }

    /// Codes a wedge of a vertex: the likely one, or any.
    [[nodiscard]] Result<std::uint32_t> code_choice(
        std::uint32_t vertex, Corner corner, std::uint32_t likely
    )
    {
        const std::uint32_t wish = wanted(corner);
        if (code_bit(coder_, state_.wedge_model.follows, wish == likely))
        {
            return likely;
        }
        std::uint32_t count = 0;
        std::uint32_t index = kNoWedge;
        for (std::uint32_t w = state_.first_wedge[vertex]; w != kNoWedge; w = state_.next_wedge[w])
        {
            index = w == wish ? count : index;
            ++count;
        }
        if (Coder::kEncodes && index == kNoWedge)
        {
            return fail(ErrorCode::Internal, "a vertex gets a wedge that it had not");
        }
        index = coder_.raw(index, static_cast<int>(std::bit_width(count - 1)));
        std::uint32_t wedge = state_.first_wedge[vertex];
        for (; index > 0 && state_.next_wedge[wedge] != kNoWedge; --index)
        {
            wedge = state_.next_wedge[wedge];
        }
        return wedge;
    }

    // ---- new vertices ----

    /// Codes the wedges of a vertex that the level before has not.
    [[nodiscard]] Result<void> code_new(std::uint32_t vertex)
    {
        if (state_.first_wedge[vertex] != kNoWedge)
        {
            return {};
        }
        walk_fan(mesh_, first_[vertex], fan_);
        const std::size_t size = fan_.corners.size();
        const std::size_t edges = fan_.closed ? size : size - 1;
        separates_.assign(size, 0);
        far_ends_.resize(edges);
        std::array<std::size_t, 3> count{};
        for (std::size_t i = 0; i < edges; ++i)
        {
            far_ends_[i] = far_end(fan_.corners[i]);
            ++count[static_cast<std::size_t>(far_ends_[i])];
        }
        bool any = false;
        if constexpr (Coder::kEncodes)
        {
            for (std::size_t i = 0; i < edges; ++i)
            {
                separates_[i] =
                    label_at(fan_.corners[i]) != label_at(fan_.corners[(i + 1) % size]) ? 1 : 0;
                any = any || separates_[i] != 0;
            }
        }
        const std::size_t context =
            std::min<std::size_t>(count[1], 3) * 4 + std::min<std::size_t>((count[2] + 1) / 2, 3);
        if (edges > (fan_.closed ? 1U : 0U) &&
            code_bit(coder_, state_.wedge_model.has_breaks[context], any))
        {
            code_breaks(vertex, edges);
        }
        return place_wedges(vertex, edges);
    }

    /// Codes which edges of the fan separate wedges; at least two do where the fan is closed, else one.
    void code_breaks(std::uint32_t vertex, std::size_t edges)
    {
        const std::size_t least = fan_.closed ? 2 : 1;
        const std::size_t straight = straight_edge(vertex, edges);
        std::size_t breaks = 0;
        for (std::size_t i = 0; i < edges; ++i)
        {
            if (breaks + (edges - i) <= least)
            {
                separates_[i] = 1;
            }
            else
            {
                const std::size_t context = static_cast<std::size_t>(far_ends_[i]) * 6 +
                                            std::min<std::size_t>(breaks, 2) * 2 +
                                            (i == straight ? 1U : 0U) + (replaced_ ? 18U : 0U);
                auto& model = state_.wedge_model.is_break[context];
                separates_[i] = code_bit(coder_, model, separates_[i] != 0) ? 1 : 0;
            }
            breaks += separates_[i];
        }
    }

    /// The edge that goes on straightest from the first one that separates wedges at its far end; none: the
    /// number of edges.
    [[nodiscard]] std::size_t straight_edge(std::uint32_t vertex, std::size_t edges) const
    {
        const auto from = std::ranges::find(far_ends_, FarEnd::Separates);
        if (from == far_ends_.end())
        {
            return edges;
        }
        const auto along = [&](std::size_t i) {
            const auto& a = mesh_.positions[vertex];
            const auto& b = mesh_.positions[mesh_.vertex(previous_corner(fan_.corners[i]))];
            return std::array<double, 3>{
                static_cast<double>(b[0] - a[0]),
                static_cast<double>(b[1] - a[1]),
                static_cast<double>(b[2] - a[2])};
        };
        const auto start = static_cast<std::size_t>(from - far_ends_.begin());
        const auto back = along(start);
        std::size_t best = edges;
        double least = 0.0;
        for (std::size_t i = 0; i < edges; ++i)
        {
            const auto on = along(i);
            const double product = back[0] * on[0] + back[1] * on[1] + back[2] * on[2];
            const double square = on[0] * on[0] + on[1] * on[1] + on[2] * on[2];
            // The cosine, but for a common factor.
            const double cosine = square > 0.0 ? product / std::sqrt(square) : 0.0;
            if (i != start && (best == edges || cosine < least))
            {
                best = i;
                least = cosine;
            }
        }
        return best;
    }

    /// Gives the runs of corners between separating edges their wedges.
    [[nodiscard]] Result<void> place_wedges(std::uint32_t vertex, std::size_t edges)
    {
        auto& corners = fan_.corners;
        const std::size_t size = corners.size();
        const auto last = std::ranges::find(separates_, std::uint8_t{1});
        // A closed fan is cut behind the first separating edge.
        const std::size_t start = fan_.closed && last != separates_.end()
                                      ? static_cast<std::size_t>(last - separates_.begin()) + 1
                                      : 0;
        std::uint32_t wedge = kNoWedge;
        for (std::size_t n = 0; n < size; ++n)
        {
            const std::size_t i = (start + n) % size;
            const std::size_t edge = (i + size - 1) % size;
            if (n == 0 || separates_[edge] != 0)
            {
                wedge = add_wedge(vertex, corners[i]);
            }
            wedge_at(corners[i]) = wedge;
            if (Coder::kEncodes && wanted(corners[i]) != wedge)
            {
                return fail(ErrorCode::Internal, "the corners of a wedge do not stand together");
            }
        }
        for (std::size_t i = 0; i < edges; ++i)
        {
            if (separates_[i] != 0)
            {
                go_on_at(mesh_.vertex(previous_corner(corners[i])));
            }
        }
        return {};
    }

    Coder& coder_;
    const LevelMesh& mesh_;
    AttributeState& state_;
    std::vector<Corner> first_;
    bool replaced_;
    WedgeSource* source_;
    std::uint32_t old_;  ///< Vertices of the level before.
    std::size_t valued_wedges_ = state_.shown.wedge_vertices.size();
    std::vector<Triangle> wedges_;
    std::vector<std::uint32_t> waiting_;
    Fan fan_;
    std::vector<std::uint8_t> separates_;  ///< By edge of the fan.
    std::vector<FarEnd> far_ends_;
};

}  // namespace vsplit::codec
