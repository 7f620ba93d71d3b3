#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace vsplit::codec {

/// Stacks of numbers, each of which lies on at most one stack; what is put on another one, or once more,
/// leaves its old place. So memory does not grow however often numbers move. Not thread safe.
class ItemStacks
{
public:
    /// Nothing on top, or below.
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    /// Empty stacks for the numbers 0 .. `items` - 1.
    ItemStacks(std::size_t stacks, std::size_t items)
        : top_(stacks, kNone), below_(items, kNone), above_(items, kOnNone)
    {
    }

    /// The number on top; kNone when the stack is empty.
    [[nodiscard]] std::uint32_t top(std::size_t stack) const { return top_[stack]; }

    /// Puts a number on top of a stack. `old`: the stack that it lies on, if it does. Cost: constant.
    void push(std::size_t stack, std::uint32_t item, std::size_t old)
    {
        remove(old, item);
        below_[item] = top_[stack];
        above_[item] = kNone;
        if (top_[stack] != kNone)
        {
            above_[top_[stack]] = item;
        }
        top_[stack] = item;
    }

    /// Takes a number from the stack that it lies on, if it does. Cost: constant.
    void remove(std::size_t stack, std::uint32_t item)
    {
        if (above_[item] == kOnNone)
        {
            return;
        }
        if (below_[item] != kNone)
        {
            above_[below_[item]] = above_[item];
        }
        std::uint32_t& upper = above_[item] == kNone ? top_[stack] : below_[above_[item]];
        upper = below_[item];
        above_[item] = kOnNone;
    }

private:
    /// Above what lies on no stack.
    static constexpr std::uint32_t kOnNone = kNone - 1;

    std::vector<std::uint32_t> top_;    ///< By stack.
    std::vector<std::uint32_t> below_;  ///< By number.
    std::vector<std::uint32_t> above_;  ///< By number; kNone on top.
};

}  // namespace vsplit::codec
