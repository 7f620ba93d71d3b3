#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

// The C library's log, exp and pow are rounded differently from library to library. What decides about
// bytes takes these instead: IEEE + - * / in a fixed order (compiled without contraction) give the same
// bits on every machine.

namespace vsplit {

inline constexpr double kLn2 = 0.69314718055994531;

/// Natural logarithm to a relative error of about 1e-13, the same on every IEEE machine.
/// Precondition: `value` is positive, finite and not subnormal. Cost: one division.
/// Source: the series of artanh, ln m = 2 artanh((m - 1) / (m + 1)), for m in [1/sqrt 2, sqrt 2).
[[nodiscard]] inline double portable_log(double value)
{
    constexpr std::uint64_t kMantissa = 0x000F'FFFF'FFFF'FFFFULL;
    constexpr std::uint64_t kOne = 0x3FF0'0000'0000'0000ULL;
    const auto bits = std::bit_cast<std::uint64_t>(value);
    auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
    double mantissa = std::bit_cast<double>((bits & kMantissa) | kOne);
    const bool upper = mantissa > 1.4142135623730951;
    mantissa = upper ? mantissa * 0.5 : mantissa;
    exponent = upper ? exponent + 1.0 : exponent;
    const double z = (mantissa - 1.0) / (mantissa + 1.0);
    const double s = z * z;
    const double tail =
        s *
        (1.0 / 3 +
         s * (1.0 / 5 +
              s * (1.0 / 7 + s * (1.0 / 9 + s * (1.0 / 11 + s * (1.0 / 13 + s * (1.0 / 15)))))));
    return exponent * kLn2 + 2.0 * (z + z * tail);
}

/// 2 to the power of `exponent` to a relative error of about 1e-15, the same on every IEEE machine.
/// Precondition: `exponent` lies within -1000 .. 1000. Cost: a polynomial of degree 14.
/// Source: the Taylor series of e^x for the fractional part.
[[nodiscard]] inline double portable_exp2(double exponent)
{
    const double whole = std::floor(exponent);
    const double x = (exponent - whole) * kLn2;
    double sum = 1.0;
    for (int i = 14; i >= 1; --i)
    {
        sum = 1.0 + sum * x / i;
    }
    return std::ldexp(sum, static_cast<int>(whole));
}

}  // namespace vsplit
