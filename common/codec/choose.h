#pragma once

#include <cstdint>

namespace vsplit::codec {

// Choices without branches: what is decoded cannot be guessed, and a wrong guess costs a processor
// more than both alternatives.

/// All bits when `condition` holds, else none.
[[nodiscard]] constexpr std::int32_t mask_if(bool condition)
{
    return -static_cast<std::int32_t>(condition);
}

/// `yes` when `condition` holds, else `no`.
[[nodiscard]] constexpr std::int32_t choose(bool condition, std::int32_t yes, std::int32_t no)
{
    return no ^ ((yes ^ no) & mask_if(condition));
}

/// The greater of two values. (By value: compilers turn std::max, which yields a reference, into a
/// branch.)
[[nodiscard]] constexpr std::int32_t greater_of(std::int32_t a, std::int32_t b)
{
    return a > b ? a : b;
}

/// The lesser of two values.
[[nodiscard]] constexpr std::int32_t lesser_of(std::int32_t a, std::int32_t b)
{
    return a < b ? a : b;
}

}  // namespace vsplit::codec
