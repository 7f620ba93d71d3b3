#pragma once

// Based on: Witten, Neal, Cleary, "Arithmetic Coding for Data Compression", 1987 (adaptive binary
// models); Mahoney, "Adaptive Weighing of Context Models for Lossless Data Compression", 2005 (sums in
// the logistic domain). All arithmetic is integer, so that every machine learns the same model.

#include "codec/choose.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>

namespace vsplit::codec {

namespace detail {

/// e^x for the tables below: halving to |x| < 2^-10, twelve Taylor terms, squaring back. Evaluated by
/// the compiler, hence the same on every machine.
[[nodiscard]] constexpr double table_exp(double x)
{
    const double small = x / 1024.0;
    double term = 1.0;
    double sum = 1.0;
    for (int i = 1; i <= 12; ++i)
    {
        term *= small / i;
        sum += term;
    }
    for (int i = 0; i < 10; ++i)
    {
        sum *= sum;
    }
    return sum;
}

/// ln(1 + y) for 0 <= y <= 1 by the series of artanh.
[[nodiscard]] constexpr double table_log1p(double y)
{
    const double z = y / (2.0 + y);
    double power = z;
    double sum = 0.0;
    for (int i = 1; i < 60; i += 2)
    {
        sum += power / i;
        power *= z * z;
    }
    return 2.0 * sum;
}

/// squash[i] = round(65536 / (1 + e^-((i - 2048) / 256))), kept within 48 .. 65488.
[[nodiscard]] constexpr std::array<std::uint16_t, 4096> make_squash()
{
    std::array<std::uint16_t, 4096> table{};
    for (int i = 0; i < 4096; ++i)
    {
        const double value = 65536.0 / (1.0 + table_exp(-(i - 2048) / 256.0));
        const double kept = value < 48.0 ? 48.0 : value > 65488.0 ? 65488.0 : value;
        table[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(kept + 0.5);
    }
    return table;
}

/// log_sum[i] = round(256 * ln(1 + e^(-i / 64))).
[[nodiscard]] constexpr std::array<std::int16_t, 1024> make_log_sum()
{
    std::array<std::int16_t, 1024> table{};
    for (int i = 0; i < 1024; ++i)
    {
        const double value = 256.0 * table_log1p(table_exp(-i / 64.0));
        table[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(value + 0.5);
    }
    return table;
}

/// adaptation[n] = floor(655360 / (10 n + 16)): the weight of the n-th observation, 1/65536.
[[nodiscard]] constexpr std::array<std::uint16_t, 128> make_adaptation()
{
    std::array<std::uint16_t, 128> table{};
    for (std::uint32_t n = 0; n < 128; ++n)
    {
        table[n] = static_cast<std::uint16_t>(655360U / (10U * n + 16U));
    }
    return table;
}

inline constexpr auto kSquash = make_squash();
inline constexpr auto kLogSum = make_log_sum();
inline constexpr auto kAdaptation = make_adaptation();

}  // namespace detail

/// Observations after which an AdaptiveBit stops slowing down.
inline constexpr std::uint16_t kAdaptiveBitMemory = 120;

/// Turns a score, 1/256 nat, into the probability of a one, 1/65536.
[[nodiscard]] inline std::uint32_t squash(std::int32_t score)
{
    const std::int32_t index = score + 2048;
    return detail::kSquash[static_cast<std::size_t>(index < 0 ? 0 : index > 4095 ? 4095 : index)];
}

/// ln(e^a + e^b) of two scores in 1/256 nat.
[[nodiscard]] inline std::int32_t log_sum(std::int32_t a, std::int32_t b)
{
    const std::int32_t larger = a > b ? a : b;
    const std::int32_t gap = (a > b ? a - b : b - a) >> 2;
    return larger + detail::kLogSum[static_cast<std::size_t>(gap < 1023 ? gap : 1023)];
}

/// Adds in two's complement, so that no sequence of hostile bits makes a weight overflow.
[[nodiscard]] inline std::int32_t wrapping_add(std::int32_t a, std::int32_t b)
{
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// A bit whose probability is learned by counting.
struct AdaptiveBit
{
    std::uint16_t probability = 32768;  ///< Of a one, 1/65536.
    std::uint16_t count = 0;            ///< Observations so far, at most kAdaptiveBitMemory.
};

/// Codes one bit with an adaptive probability; `coder` is a BitEncoder or BitDecoder.
template <typename Coder>
inline bool code_bit(Coder& coder, AdaptiveBit& model, bool value)
{
    const std::uint32_t used = ((model.probability * 1023U) >> 10) + 32U;
    const bool result = coder.bit(used, value);
    const std::int32_t target = 65535 & mask_if(result);
    const std::int32_t step =
        ((target - model.probability) * std::int32_t{detail::kAdaptation[model.count]}) >> 16;
    model.probability = static_cast<std::uint16_t>(model.probability + step);
    model.count = static_cast<std::uint16_t>(model.count + (model.count < kAdaptiveBitMemory));
    return result;
}

/// Sum of the entries that a context selects. Written without a loop, so that the pointers stay in
/// registers.
template <std::size_t N>
[[gnu::always_inline]] inline std::int32_t weight_sum(const std::array<std::int32_t*, N>& weights)
{
    const auto sum = [](const auto*... weight) {
        return static_cast<std::int32_t>((static_cast<std::uint32_t>(*weight) + ...));
    };
    return std::apply(sum, weights);
}

/// Adds `step` to the entries that a context selects, one after another.
template <std::size_t N>
[[gnu::always_inline]] inline void add_to_weights(
    const std::array<std::int32_t*, N>& weights, std::int32_t step
)
{
    std::apply([&](auto*... weight) { ((*weight = wrapping_add(*weight, step)), ...); }, weights);
}

/// Codes one bit whose score is a sum of learned weights (units of 1/65536 nat).
/// `weights`: the entries that the context selects; `rate`: learning rate, 1/32768.
template <typename Coder, std::size_t N>
[[gnu::always_inline]] inline bool code_logistic(
    Coder& coder, const std::array<std::int32_t*, N>& weights, bool value, std::int32_t rate
)
{
    const std::uint32_t probability = squash(weight_sum(weights) >> 8);
    const bool result = coder.bit(probability, value);
    const std::int32_t error = (65535 & mask_if(result)) - static_cast<std::int32_t>(probability);
    add_to_weights(weights, (error * rate) >> 15);
    return result;
}

/// Learned statistics of a signed integer: Exp-Golomb with modelled prefix and leading mantissa bits.
struct IntegerModel
{
    AdaptiveBit nonzero;
    std::array<AdaptiveBit, 3> sign;
    std::array<AdaptiveBit, 24> prefix;
    std::array<std::array<AdaptiveBit, 3>, 24> mantissa;
};

/// Largest magnitude that code_integer() can produce.
inline constexpr std::int32_t kMaxCodedInteger = (1 << 24) - 1;

/// Codes the low bits of a magnitude whose highest set bit is `exponent`; the two highest of them are
/// modelled, the others raw. Returns the magnitude.
template <typename Coder>
inline std::uint32_t code_mantissa(
    Coder& coder, IntegerModel& model, std::uint32_t magnitude, int exponent
)
{
    if (exponent == 0)
    {
        return 1;
    }
    auto& bits = model.mantissa[static_cast<std::size_t>(exponent)];
    const auto wanted = [&](int position) { return ((magnitude >> position) & 1U) != 0; };
    const bool first = code_bit(coder, bits[0], wanted(exponent - 1));
    std::uint32_t value = 2U + (first ? 1U : 0U);
    if (exponent > 1)
    {
        const bool second = code_bit(coder, bits[first ? 2 : 1], wanted(exponent - 2));
        value = value * 2U + (second ? 1U : 0U);
    }
    if (exponent > 2)
    {
        const int rest = exponent - 2;
        value = (value << rest) | coder.raw(magnitude, rest);
    }
    return value;
}

/// Codes a signed integer of magnitude at most kMaxCodedInteger.
/// `sign_context`: 0 .. 2, which way the prediction was rounded.
template <typename Coder>
inline std::int32_t code_integer(
    Coder& coder, IntegerModel& model, std::int32_t value, std::size_t sign_context
)
{
    if (!code_bit(coder, model.nonzero, value != 0))
    {
        return 0;
    }
    const bool negative = code_bit(coder, model.sign[sign_context], value < 0);
    const auto magnitude = static_cast<std::uint32_t>(value < 0 ? -value : value);
    const int wanted = static_cast<int>(std::bit_width(magnitude)) - 1;
    int exponent = 0;
    while (exponent < 23 &&
           code_bit(coder, model.prefix[static_cast<std::size_t>(exponent)], exponent < wanted))
    {
        ++exponent;
    }
    const auto result = static_cast<std::int32_t>(code_mantissa(coder, model, magnitude, exponent));
    return negative ? -result : result;
}

/// Codes a number below 2^31: its length in bits, then the bits.
template <typename Coder>
[[nodiscard]] std::uint32_t code_count(Coder& coder, std::uint32_t count)
{
    const std::uint32_t bits = coder.raw(static_cast<std::uint32_t>(std::bit_width(count)), 5);
    return coder.raw(count, static_cast<int>(bits));
}

}  // namespace vsplit::codec
