#pragma once

#include "codec/attribute_state.h"
#include "codec/item_stacks.h"
#include "codec/level_mesh.h"

#include <algorithm>
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
        : mesh_(mesh),
          wedges_(wedges),
          begin_(count + 1ULL, 0),
          known_(count, 0),
          waiting_(kMostPriority + 1, count)
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
        for (std::size_t slot = 0; slot < wedges.size(); ++slot)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                corners_[begin_[wedges[slot][k]]++] = static_cast<Corner>(4 * slot + k);
            }
        }
        // Each begins where the next one ended up now.
        std::copy_backward(begin_.begin(), begin_.end() - 1, begin_.end());
        begin_.front() = 0;
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
        while (best_ > 0 && waiting_.top(best_) == ItemStacks::kNone)
        {
            --best_;
        }
        const std::uint32_t wedge = waiting_.top(best_);
        if (wedge == ItemStacks::kNone)
        {
            return kNoWedge;
        }
        waiting_.remove(best_, wedge);
        return wedge;
    }

    /// Notes that the values of a wedge are known now.
    void know(std::uint32_t wedge)
    {
        known_[wedge] = 1;
        waiting_.remove(priority_[wedge], wedge);
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
            waiting_.push(priority_[w], static_cast<std::uint32_t>(w), priority_[w]);
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
            waiting_.push(static_cast<std::size_t>(sum), wedge, priority_[wedge]);
            priority_[wedge] = static_cast<std::uint8_t>(sum);
            best_ = std::max<std::size_t>(best_, priority_[wedge]);
        }
    }

    const LevelMesh& mesh_;
    std::span<const Triangle> wedges_;
    std::vector<std::uint32_t> begin_;
    std::vector<Corner> corners_;
    std::vector<std::uint8_t> known_;
    std::vector<std::uint8_t> priority_;
    ItemStacks waiting_;  ///< By priority the wedges that wait.
    std::size_t best_ = 0;
};

}  // namespace vsplit::codec
