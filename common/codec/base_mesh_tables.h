#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace vsplit::codec {

/// Bounds of the entropy coder's tables in a Draco mesh of positions, as our encoder makes it. A decoder
/// that holds a stream to them knows what memory Draco takes before Draco takes it.
/// Source: Draco 1.5, compression/entropy/symbol_encoding.cc and rans_symbol_coding.h.
struct BaseMeshTables
{
    std::uint32_t symbol_bits = 0;  ///< Largest "unique symbols bit length", which sizes a table.
    std::uint32_t symbols = 0;      ///< Largest number of symbols.

    /// `vertices`: of the base mesh; `max_index`: its largest coordinate.
    [[nodiscard]] static BaseMeshTables of(std::uint32_t vertices, std::uint32_t max_index)
    {
        constexpr std::uint32_t kMostBits = 18;
        // One symbol a coordinate; Draco adds two bits at its highest compression level. Corrections
        // are wrapped to the range of the coordinates, then made positive.
        return {
            std::min<std::uint32_t>(
                kMostBits,
                static_cast<std::uint32_t>(std::bit_width(std::uint64_t{vertices} * 3)) + 2
            ),
            std::min(std::uint32_t{1} << kMostBits, 2 * max_index + 4),
        };
    }

    /// Heap that such tables take, bytes: the look-up table and three words a symbol.
    [[nodiscard]] std::uint64_t heap_bytes() const
    {
        return (std::uint64_t{4} << std::clamp(symbol_bits * 3 / 2, 12U, 20U)) +
               std::uint64_t{12} * symbols;
    }
};

}  // namespace vsplit::codec
