#pragma once

// Texture coordinates of coarse levels lack low bits, as positions do: finer ones would not be seen there.
// Numbers that lack bits stand in the middle of their cell. Encoder and decoder run this same code.

#include "codec/attribute_state.h"
#include "core/result.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Raw bits that tell how many bits numbers lack.
inline constexpr int kLackingBits = 4;

/// Tells whether numbers of an attribute may lack bits.
[[nodiscard]] inline bool may_lack_bits(const AttributeInfo& info)
{
    return info.kind == AttributeKind::TexCoord;
}

/// The middle of the numbers that are equal to `number` but for their `lacks` low bits.
[[nodiscard]] inline std::int32_t middle_of(std::int32_t number, int lacks)
{
    return lacks == 0 ? number : (number >> lacks << lacks) + (1 << (lacks - 1));
}

/// Gives a number that lacks `from` bits all but `to` of them. `wanted`: encoder only, the exact number.
template <typename Coder>
[[nodiscard]] std::int32_t refine_number(
    Coder& coder, std::int32_t number, int from, int to, std::int32_t wanted
)
{
    const int count = from - to;
    const auto all = static_cast<std::uint32_t>(wanted >> to);
    const std::uint32_t low = all & ((1U << count) - 1U);
    const std::uint32_t bits = coder.raw(low, count);
    return middle_of(((number >> from << count) + static_cast<std::int32_t>(bits)) << to, to);
}

/// Codes at the start of a level which bits its numbers lack, and refines those that are known.
/// `known`: wedges with values; `first`: no level came before; `wanted`: encoder only, by attribute what numbers
/// lack and the exact numbers, by wedge. Error: BadChunk.
template <typename Coder>
[[nodiscard]] Result<void> code_precision(
    Coder& coder,
    std::span<const AttributeInfo> attributes,
    AttributeState& state,
    std::uint32_t known,
    bool first,
    [[maybe_unused]] std::span<const std::uint8_t> lacks,
    [[maybe_unused]] std::span<const std::vector<std::int32_t>> wanted
)
{
    for (std::size_t a = 0; a < attributes.size(); ++a)
    {
        const int before = state.lacks[a];
        if (!may_lack_bits(attributes[a]) || (!first && before == 0))
        {
            continue;
        }
        const auto now = static_cast<int>(coder.raw(Coder::kEncodes ? lacks[a] : 0, kLackingBits));
        if (first ? now >= attributes[a].bits : now > before)
        {
            return fail(ErrorCode::BadChunk, "texture coordinates lack more bits than they may");
        }
        state.lacks[a] = static_cast<std::uint8_t>(now);
        const std::size_t numbers = first ? 0 : known * coded_components(attributes[a]);
        for (std::size_t i = 0; i < numbers; ++i)
        {
            std::int32_t& number = state.shown.values[a][i];
            number = refine_number(coder, number, before, now, Coder::kEncodes ? wanted[a][i] : 0);
        }
    }
    return {};
}

/// Bits that one wedge still lacks, all attributes together.
[[nodiscard]] inline std::uint32_t lacking_bits(
    std::span<const AttributeInfo> attributes, const AttributeState& state
)
{
    std::uint32_t bits = 0;
    for (std::size_t a = 0; a < attributes.size(); ++a)
    {
        bits += static_cast<std::uint32_t>(state.lacks[a] * coded_components(attributes[a]));
    }
    return bits;
}

/// Codes all bits that the numbers of a wedge lack. `wanted`: encoder only, as above.
template <typename Coder>
void complete_wedge(
    Coder& coder,
    std::span<const AttributeInfo> attributes,
    AttributeState& state,
    std::size_t wedge,
    [[maybe_unused]] std::span<const std::vector<std::int32_t>> wanted
)
{
    for (std::size_t a = 0; a < attributes.size(); ++a)
    {
        const std::size_t numbers = state.lacks[a] == 0 ? 0 : coded_components(attributes[a]);
        for (std::size_t i = wedge * numbers; i < (wedge + 1) * numbers; ++i)
        {
            std::int32_t& number = state.shown.values[a][i];
            number =
                refine_number(coder, number, state.lacks[a], 0, Coder::kEncodes ? wanted[a][i] : 0);
        }
    }
}

}  // namespace vsplit::codec
