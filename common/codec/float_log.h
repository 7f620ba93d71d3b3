#pragma once

#include <bit>
#include <cfloat>
#include <cstdint>

namespace vsplit::codec {

// Every operation must be rounded to binary32 at once; x87 registers would give other meshes.
static_assert(FLT_EVAL_METHOD == 0, "compile for a target that evaluates float as float");

/// A piecewise linear logarithm: 2^kStepsLog2 * log2(value), read off the bits of an IEEE-754 binary32,
/// rounded down; exact at powers of two and at most 0.09 octaves low between them.
/// Precondition: `value` > 0 and finite. Deterministic on every IEEE machine.
template <int kStepsLog2>
[[nodiscard]] inline std::int32_t steps_log2(float value)
{
    constexpr int kMantissaBits = 23 - kStepsLog2;
    return static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(value) >> kMantissaBits) -
           (127 << kStepsLog2);
}

/// Keeps a value within low .. high.
[[nodiscard]] constexpr std::int32_t clamp_int(
    std::int32_t value, std::int32_t low, std::int32_t high
)
{
    return value < low ? low : value > high ? high : value;
}

}  // namespace vsplit::codec
