// Based on: Castagnoli, Braeuer, Herrmann, "Optimization of Cyclic Redundancy-Check Codes with 24
// and 32 Parity Bits", IEEE Transactions on Communications 41 (1993); RFC 3720, appendix B.4.
#include "core/crc32c.h"

#include <array>

namespace vsplit {
namespace {

constexpr std::array<std::uint32_t, 256> make_table()
{
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i)
    {
        std::uint32_t value = i;
        for (int bit = 0; bit < 8; ++bit)
        {
            value = (value >> 1) ^ ((value & 1U) != 0 ? 0x82F63B78U : 0U);
        }
        table[i] = value;
    }
    return table;
}

constexpr std::array<std::uint32_t, 256> kTable = make_table();

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t previous)
{
    std::uint32_t crc = ~previous;
    for (const std::byte byte : bytes)
    {
        crc = (crc >> 8) ^ kTable[(crc ^ static_cast<std::uint32_t>(byte)) & 0xFFU];
    }
    return ~crc;
}

}  // namespace vsplit
