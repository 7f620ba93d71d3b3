#pragma once

#include <cstdint>

namespace vsplit::codec {

/// Most vertices of a base that SmallBaseCoder codes: its time grows with their square.
inline constexpr std::uint32_t kMaxSmallBaseVertices = 4096;

/// Most faces of such a base per vertex, which bounds its memory.
inline constexpr std::uint32_t kMaxSmallBaseFaces = 3;

/// Where SmallBaseCoder expects the first vertex of a component.
enum class ComponentStart : std::uint8_t
{
    Centre,      ///< In the middle of the grid.
    LastVertex,  ///< Where the last vertex of the component before is; the first one in the middle.
};

}  // namespace vsplit::codec
