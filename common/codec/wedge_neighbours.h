#pragma once

#include "codec/attribute_state.h"
#include "codec/level_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// The corners of every wedge of a level, and in which order wedges are coded: those come first about whose
/// surroundings most is known. Not thread safe.
class WedgeNeighbours
{
public:
    /// `mesh`, `wedges`: of the level, must outlive this; `count`: wedges; those below `known` are known.
    WedgeNeighbours(
        const LevelMesh& mesh,
        std::span<const Triangle> wedges,
        std::uint32_t count,
        std::uint32_t known
    )
        : mesh_(mesh), wedges_(wedges), begin_(count + 1ULL, 0), known_(count, 0)
    {
        for (const Triangle& triangle : wedges)
        {
            for (const std::uint32_t wedge : triangle)
            {
                ++begin_[wedge + 1ULL];
            }
        }
        for (std::size_t w = 0; w < count; ++w)
        {
            begin_[w + 1] += begin_[w];
        }
        corners_.resize(begin_.back());
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::size_t slot = 0; slot < wedges.size(); ++slot)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                corners_[next[wedges[slot][k]]++] = static_cast<Corner>(4 * slot + k);
            }
        }
        std::fill_n(known_.begin(), known, std::uint8_t{1});
        start_order(known);
    }

    /// Wedge at a corner.
    [[nodiscard]] std::uint32_t wedge(Corner corner) const
    {
        return wedges_[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    }

    /// Corners of a wedge, ascending.
    [[nodiscard]] std::span<const Corner> corners(std::uint32_t wedge) const
    {
        return std::span(corners_).subspan(begin_[wedge], begin_[wedge + 1ULL] - begin_[wedge]);
    }

    /// True for wedges whose values are known.
    [[nodiscard]] bool is_known(std::uint32_t wedge) const { return known_[wedge] != 0; }

    /// The wedge across the edge opposite to a corner, on the same side of every seam; kNoWedge when there
    /// is none.
    [[nodiscard]] std::uint32_t beyond(Corner corner) const
    {
        const Corner across = mesh_.across(corner);
        if (across < 0 || wedge(next_corner(across)) != wedge(previous_corner(corner)) ||
            wedge(previous_corner(across)) != wedge(next_corner(corner)))
        {
            return kNoWedge;
        }
        return wedge(across);
    }

    /// Takes the wedge to code next; kNoWedge when all are known.
    [[nodiscard]] std::uint32_t take()
    {
        while (true)
        {
            while (best_ > 0 && waiting_[best_].empty())
            {
                --best_;
            }
            if (waiting_[best_].empty())
            {
                return kNoWedge;
            }
            const std::uint32_t wedge = waiting_[best_].back();
            waiting_[best_].pop_back();
            if (known_[wedge] == 0 && priority_[wedge] == best_)
            {
                return wedge;
            }
        }
    }

    /// Notes that the values of a wedge are known now.
    void know(std::uint32_t wedge)
    {
        known_[wedge] = 1;
        for (const Corner corner : corners(wedge))
        {
            const std::uint32_t a = this->wedge(next_corner(corner));
            const std::uint32_t b = this->wedge(previous_corner(corner));
            raise(a, known_[b] != 0 ? 3 : 1);
            raise(b, known_[a] != 0 ? 3 : 1);
        }
    }

private:
    static constexpr std::uint8_t kMostPriority = 31;

    /// Priorities of all that is not known, later ones below earlier ones.
    void start_order(std::uint32_t known)
    {
        priority_.assign(known_.size(), 0);
        for (std::size_t w = known_.size(); w-- > known;)
        {
            int sum = 0;
            for (const Corner corner : corners(static_cast<std::uint32_t>(w)))
            {
                const int a = known_[wedge(next_corner(corner))];
                const int b = known_[wedge(previous_corner(corner))];
                sum += a + b + 2 * a * b;
            }
            priority_[w] = static_cast<std::uint8_t>(std::min<int>(sum, kMostPriority));
            waiting_[priority_[w]].push_back(static_cast<std::uint32_t>(w));
            best_ = std::max<std::size_t>(best_, priority_[w]);
        }
    }

    void raise(std::uint32_t wedge, int by)
    {
        if (known_[wedge] != 0)
        {
            return;
        }
        const int sum = std::min<int>(priority_[wedge] + by, kMostPriority);
        if (sum != priority_[wedge])
        {
            priority_[wedge] = static_cast<std::uint8_t>(sum);
            waiting_[priority_[wedge]].push_back(wedge);
            best_ = std::max<std::size_t>(best_, priority_[wedge]);
        }
    }

    const LevelMesh& mesh_;
    std::span<const Triangle> wedges_;
    std::vector<std::uint32_t> begin_;
    std::vector<Corner> corners_;
    std::vector<std::uint8_t> known_;
    std::vector<std::uint8_t> priority_;
    /// By priority the wedges that wait; those whose priority rose or that are known now are passed over.
    std::array<std::vector<std::uint32_t>, kMostPriority + 1> waiting_;
    std::size_t best_ = 0;
};

}  // namespace vsplit::codec
