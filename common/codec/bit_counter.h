#pragma once

#include "codec/context_model.h"
#include "codec/entropy_coder.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

namespace detail {

/// bit_cost[p] = round(-256 log2(p / 256)), p >= 1: what a bit of that probability costs.
[[nodiscard]] constexpr std::array<std::uint16_t, 257> make_bit_costs()
{
    constexpr double kLn2 = 0.69314718055994530942;
    std::array<std::uint16_t, 257> table{};
    for (int p = 1; p <= 256; ++p)
    {
        int octave = 0;
        double mantissa = p;
        while (mantissa >= 2.0)
        {
            mantissa *= 0.5;
            ++octave;
        }
        const double log2 = octave + table_log1p(mantissa - 1.0) / kLn2;
        table[static_cast<std::size_t>(p)] = static_cast<std::uint16_t>(256.0 * (8.0 - log2) + 0.5);
    }
    return table;
}

inline constexpr auto kBitCosts = make_bit_costs();

}  // namespace detail

/// Stands in for a BitEncoder where only the length matters: learns what it would learn, writes
/// nothing. Not thread safe.
class BitCounter
{
public:
    static constexpr bool kEncodes = true;

    /// As BitEncoder::bit().
    bool bit(std::uint32_t one_probability, bool value)
    {
        const std::uint32_t zero = zero_probability(one_probability);
        cost_ += detail::kBitCosts[value ? 256U - zero : zero];
        return value;
    }

    /// As BitEncoder::raw().
    std::uint32_t raw(std::uint32_t value, int count)
    {
        cost_ += static_cast<std::uint64_t>(count) * 256U;
        return value & static_cast<std::uint32_t>((1ULL << count) - 1ULL);
    }

    /// Bytes so far, rounded up.
    [[nodiscard]] std::size_t bytes() const
    {
        return static_cast<std::size_t>((cost_ + 2047) >> 11);
    }

private:
    std::uint64_t cost_ = 0;  ///< 1/256 bit.
};

/// A BitEncoder that tells how long its chunk will be. Not thread safe.
class MeasuredEncoder
{
public:
    static constexpr bool kEncodes = true;

    /// As BitEncoder::bit().
    bool bit(std::uint32_t one_probability, bool value)
    {
        counter_.bit(one_probability, value);
        return bits_.bit(one_probability, value);
    }

    /// As BitEncoder::raw().
    std::uint32_t raw(std::uint32_t value, int count)
    {
        counter_.raw(value, count);
        return bits_.raw(value, count);
    }

    /// Bytes so far, rounded up.
    [[nodiscard]] std::size_t bytes() const { return counter_.bytes(); }

    /// What was taken.
    [[nodiscard]] const BitEncoder& bits() const { return bits_; }

private:
    BitEncoder bits_;
    BitCounter counter_;
};

}  // namespace vsplit::codec
