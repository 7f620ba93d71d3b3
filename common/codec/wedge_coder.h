#pragma once

// Based on: Isenburg, Snoeyink, "Compressing Texture Coordinates with Selective Linear Predictions", 2003
// (seams told vertex by vertex); Hoppe, "Efficient Implementation of Progressive Meshes", 1998, section 3
// (wedges). Seams are followed along their course. Encoder and decoder run this same code.

#include "codec/attribute_state.h"
#include "codec/known_wedge_coder.h"
#include "codec/level_mesh.h"
#include "codec/wedge_work.h"
#include "core/result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// Codes which corners of a level share a wedge. Not thread safe. Safe on untrusted input.
template <typename Coder>
class WedgeCoder
{
public:
    /// `mesh`: the level's; `state`: after the level before, changed by run(); `replaced`: the triangles
    /// have nothing to do with those of the level before; `most_wedges`: of the level; `source`: encoder
    /// only.
    WedgeCoder(
        Coder& coder,
        const LevelMesh& mesh,
        AttributeState& state,
        bool replaced,
        std::uint32_t most_wedges,
        WedgeSource* source
    )
        : work_{
              .coder = coder,
              .mesh = mesh,
              .state = state,
              .source = source,
              .old = static_cast<std::uint32_t>(state.first_wedge.size()),
              .first = first_corners(mesh),
              .wedges = std::vector<Triangle>(
                  mesh.triangles.size(), Triangle{kNoWedge, kNoWedge, kNoWedge}
              ),
              .waiting = ItemStacks(1, mesh.positions.size() - state.first_wedge.size())},
          replaced_(replaced),
          most_(most_wedges)
    {
        state.first_wedge.resize(mesh.positions.size(), kNoWedge);
    }

    /// Codes the level. Errors: Internal when what is wanted contradicts the level before; BadChunk when
    /// there are too many wedges.
    [[nodiscard]] Result<void> run()
    {
        keep_known();
        if (work_.coder.raw(Coder::kEncodes && has_seams() ? 1 : 0, 1) == 0)
        {
            return fill_without_seams();
        }
        VSPLIT_TRY(code_known());
        VSPLIT_TRY(follow_seams());
        for (std::uint32_t v = work_.old; v < work_.state.first_wedge.size(); ++v)
        {
            VSPLIT_TRY(code_new(v));
            VSPLIT_TRY(follow_seams());
        }
        work_.state.shown.wedges = std::move(work_.wedges);
        return {};
    }

private:
    /// Takes over what the level before tells: corners that stay, and vertices with one wedge.
    void keep_known()
    {
        const auto& before = work_.state.shown.wedges;
        for (std::size_t slot = 0; slot < work_.wedges.size(); ++slot)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::uint32_t vertex = work_.mesh.triangles[slot][k];
                if (vertex >= work_.old)
                {
                    continue;
                }
                const bool stays = !replaced_ && slot < before.size() &&
                                   work_.state.shown.wedge_vertices[before[slot][k]] == vertex;
                if (stays || work_.is_single(vertex))
                {
                    work_.wedges[slot][k] =
                        stays ? before[slot][k] : work_.state.first_wedge[vertex];
                }
            }
        }
    }

    [[nodiscard]] Result<void> code_known()
    {
        KnownWedgeCoder<Coder> known(work_);
        for (std::uint32_t v = 0; v < work_.old; ++v)
        {
            VSPLIT_TRY(known.code(v));
        }
        return {};
    }

    [[nodiscard]] bool has_seams()
    {
        for (std::uint32_t v = 0; v < work_.state.first_wedge.size(); ++v)
        {
            if (v < work_.old ? !work_.is_single(v) : has_breaks(v))
            {
                return true;
            }
        }
        return false;
    }

    /// Encoder only: whether a new vertex has several wedges.
    [[nodiscard]] bool has_breaks(std::uint32_t vertex)
    {
        walk_fan(work_.mesh, work_.first[vertex], fan_);
        const std::uint32_t label = work_.label_at(fan_.corners.front());
        return std::ranges::any_of(fan_.corners, [&](Corner c) {
            return work_.label_at(c) != label;
        });
    }

    [[nodiscard]] Result<void> fill_without_seams()
    {
        VSPLIT_TRY(check_count(work_.state.first_wedge.size() - work_.old));
        for (std::uint32_t v = work_.old; v < work_.state.first_wedge.size(); ++v)
        {
            work_.state.first_wedge[v] = add_wedge(v, work_.first[v]);
        }
        for (std::size_t slot = 0; slot < work_.wedges.size(); ++slot)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                if (work_.wedges[slot][k] == kNoWedge)
                {
                    work_.wedges[slot][k] = work_.state.first_wedge[work_.mesh.triangles[slot][k]];
                }
            }
        }
        work_.state.shown.wedges = std::move(work_.wedges);
        return {};
    }

    /// Checks that the level may have `count` wedges more.
    [[nodiscard]] Result<void> check_count(std::size_t count) const
    {
        const std::size_t wedges = work_.state.shown.wedge_vertices.size();
        return wedges <= most_ && count <= most_ - wedges
                   ? Result<void>{}
                   : fail(ErrorCode::BadChunk, "a level has more wedges than the header says");
    }

    /// Adds a wedge of a vertex. `corner`: one that has it.
    std::uint32_t add_wedge(std::uint32_t vertex, [[maybe_unused]] Corner corner)
    {
        const auto wedge = static_cast<std::uint32_t>(work_.state.shown.wedge_vertices.size());
        work_.state.shown.wedge_vertices.push_back(vertex);
        work_.state.next_wedge.push_back(kNoWedge);
        if constexpr (Coder::kEncodes)
        {
            work_.source->number_of[work_.label_at(corner)] = wedge;
            work_.source->label_of.push_back(work_.label_at(corner));
        }
        return wedge;
    }

    [[nodiscard]] Result<void> follow_seams()
    {
        while (work_.waiting.top(0) != ItemStacks::kNone)
        {
            const std::uint32_t vertex = work_.waiting.top(0);
            work_.waiting.remove(0, vertex);
            VSPLIT_TRY(code_new(work_.old + vertex));
        }
        return {};
    }

    /// Codes the wedges of a vertex that the level before has not.
    [[nodiscard]] Result<void> code_new(std::uint32_t vertex)
    {
        if (work_.state.first_wedge[vertex] != kNoWedge)
        {
            return {};
        }
        walk_fan(work_.mesh, work_.first[vertex], fan_);
        const std::size_t size = fan_.corners.size();
        const std::size_t edges = fan_.closed ? size : size - 1;
        separates_.assign(size, 0);
        far_ends_.resize(edges);
        std::array<std::size_t, 3> count{};
        for (std::size_t i = 0; i < edges; ++i)
        {
            far_ends_[i] = work_.far_end(fan_.corners[i]);
            ++count[static_cast<std::size_t>(far_ends_[i])];
        }
        bool any = false;
        if constexpr (Coder::kEncodes)
        {
            for (std::size_t i = 0; i < edges; ++i)
            {
                separates_[i] =
                    work_.label_at(fan_.corners[i]) != work_.label_at(fan_.corners[(i + 1) % size])
                        ? 1
                        : 0;
                any = any || separates_[i] != 0;
            }
        }
        const std::size_t context =
            std::min<std::size_t>(count[1], 3) * 4 + std::min<std::size_t>((count[2] + 1) / 2, 3);
        if (edges > (fan_.closed ? 1U : 0U) &&
            code_bit(work_.coder, work_.state.wedge_model.has_breaks[context], any))
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
                auto& model = work_.state.wedge_model.is_break[context];
                separates_[i] = code_bit(work_.coder, model, separates_[i] != 0) ? 1 : 0;
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
            const auto& a = work_.mesh.positions[vertex];
            const auto& b =
                work_.mesh.positions[work_.mesh.vertex(previous_corner(fan_.corners[i]))];
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
        const auto breaks = static_cast<std::size_t>(std::ranges::count(separates_, 1));
        VSPLIT_TRY(check_count(fan_.closed ? std::max<std::size_t>(breaks, 1) : breaks + 1));
        std::uint32_t wedge = kNoWedge;
        for (std::size_t n = 0; n < size; ++n)
        {
            const std::size_t i = (start + n) % size;
            const std::size_t edge = (i + size - 1) % size;
            if (n == 0 || separates_[edge] != 0)
            {
                const std::uint32_t next = add_wedge(vertex, corners[i]);
                (n == 0 ? work_.state.first_wedge[vertex] : work_.state.next_wedge[wedge]) = next;
                wedge = next;
            }
            work_.wedge_at(corners[i]) = wedge;
            if (Coder::kEncodes && work_.wanted(corners[i]) != wedge)
            {
                return fail(ErrorCode::Internal, "the corners of a wedge do not stand together");
            }
        }
        for (std::size_t i = 0; i < edges; ++i)
        {
            if (separates_[i] != 0)
            {
                work_.go_on_at(work_.mesh.vertex(previous_corner(corners[i])));
            }
        }
        return {};
    }

    WedgeWork<Coder> work_;
    bool replaced_;
    std::uint32_t most_;
    Fan fan_;
    std::vector<std::uint8_t> separates_;  ///< By edge of the fan.
    std::vector<FarEnd> far_ends_;
};

}  // namespace vsplit::codec
