#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit {

/// Computes the CRC-32C (Castagnoli, reflected polynomial 0x82F63B78) of a byte range.
/// `bytes`: any bytes; `previous`: the checksum of the bytes before them, 0 at the start.
/// Cost: one table look-up a byte. Thread safe.
/// Source: RFC 3720, appendix B.4.
[[nodiscard]] std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t previous = 0);

/// What crc32c() gives for any bytes followed by their own checksum in little-endian order.
inline constexpr std::uint32_t kCrc32cResidue = 0x48674BC7;

}  // namespace vsplit
