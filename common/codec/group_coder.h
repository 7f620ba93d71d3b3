#pragma once

#include "codec/attribute_state.h"
#include "codec/level_mesh.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Codes which group every triangle of a level belongs to. Triangles that share a wedge on both ends of an
/// edge belong to one group; elsewhere the neighbour's is the best guess.
/// `mesh`: of the level; `state`: with the level's wedges; `kept`: triangles from the beginning on whose
/// group is known; `count`: groups; `wanted`: encoder only, by slot. Safe on untrusted input.
template <typename Coder>
void code_groups(
    Coder& coder,
    const LevelMesh& mesh,
    AttributeState& state,
    std::size_t kept,
    std::uint32_t count,
    [[maybe_unused]] std::span<const std::uint32_t> wanted
)
{
    constexpr std::uint32_t kNone = 0xFFFFFFFF;
    auto& groups = state.shown.groups;
    groups.resize(kept);
    groups.resize(mesh.triangles.size(), kNone);
    const auto& wedges = state.shown.wedges;
    const auto at = [&](Corner corner) {
        return wedges[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    };
    const int bits = static_cast<int>(std::bit_width(count - 1));
    std::uint32_t last = 0;
    for (std::size_t slot = kept; slot < groups.size(); ++slot)
    {
        std::uint32_t likely = kNone;
        bool certain = false;
        for (std::size_t k = 0; k < 3 && !certain; ++k)
        {
            const auto corner = static_cast<Corner>(4 * slot + k);
            const Corner across = mesh.across(corner);
            if (across < 0 || groups[static_cast<std::size_t>(across >> 2)] == kNone)
            {
                continue;
            }
            certain = at(next_corner(across)) == at(previous_corner(corner)) &&
                      at(previous_corner(across)) == at(next_corner(corner));
            likely =
                certain || likely == kNone ? groups[static_cast<std::size_t>(across >> 2)] : likely;
        }
        if (certain)
        {
            groups[slot] = likely;
            continue;
        }
        const std::size_t context = likely == kNone ? 0 : likely == last ? 1 : 2;
        likely = likely == kNone ? last : likely;
        std::uint32_t group = likely;
        const bool other = Coder::kEncodes && wanted[slot] != likely;
        if (code_bit(coder, state.wedge_model.group[context], other))
        {
            std::uint32_t wish = 0;
            if constexpr (Coder::kEncodes)
            {
                wish = wanted[slot];
            }
            group = coder.raw(wish, bits);
            group = group < count ? group : count - 1;
        }
        groups[slot] = group;
        last = group;
    }
}

}  // namespace vsplit::codec
