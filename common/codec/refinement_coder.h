#pragma once

#include "codec/context_model.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

/// Learned statistics of coordinates that gain precision and may leave their cell at the same time.
struct RefinementModel
{
    /// A first guess: seven of eight stay, every further cell is as rare.
    static constexpr AdaptiveBit kStays{.probability = 8192, .count = 8};

    static constexpr std::size_t kMostCells = 16;

    /// By how many of the vertex's coordinates before have left their cell, and cells left so far:
    /// does it go further?
    std::array<std::array<AdaptiveBit, kMostCells>, 3> further = filled();

private:
    static constexpr std::array<std::array<AdaptiveBit, kMostCells>, 3> filled()
    {
        std::array<std::array<AdaptiveBit, kMostCells>, 3> result{};
        for (auto& row : result)
        {
            row.fill(kStays);
        }
        return result;
    }
};

/// Largest distance, in halves of a cell, that code_step() can carry a coordinate out of its cell.
inline constexpr std::int32_t kMostCellsLeft = RefinementModel::kMostCells;

/// Codes what a coordinate adds to its old value times 2^steps: 0 .. 2^steps - 1 when it stays in its
/// cell, less or more when it leaves it. `steps`: bits gained, at least 1; `left`: coordinates of the
/// vertex that left their cell so far, counted on. Result: the number to add.
template <typename Coder>
[[nodiscard]] std::int32_t code_step(
    Coder& coder, RefinementModel& model, std::int32_t wanted, int steps, std::size_t& left
)
{
    const std::int32_t half = wanted >> (steps - 1);
    const bool upper = coder.raw(half > 0 ? 1U : 0U, 1) != 0;
    const std::int32_t distance = upper ? half - 1 : -half;
    auto& further = model.further[left];
    std::int32_t cells = 0;
    while (cells < kMostCellsLeft &&
           code_bit(coder, further[static_cast<std::size_t>(cells)], cells < distance))
    {
        ++cells;
    }
    left += cells > 0 ? 1 : 0;
    const auto mask = (std::uint32_t{1} << (steps - 1)) - 1;
    const std::uint32_t rest = coder.raw(static_cast<std::uint32_t>(wanted) & mask, steps - 1);
    return (upper ? cells + 1 : -cells) * (std::int32_t{1} << (steps - 1)) +
           static_cast<std::int32_t>(rest);
}

/// Says whether code_step() can code what is added.
[[nodiscard]] inline bool is_in_reach(std::int32_t added, int steps)
{
    const std::int32_t half = added >> (steps - 1);
    return half > 0 ? half - 1 <= kMostCellsLeft : -half <= kMostCellsLeft;
}

}  // namespace vsplit::codec
