#pragma once

#include "codec/attribute_state.h"
#include "codec/item_stacks.h"
#include "codec/level_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// What an encoder wants: which wedge of the source is at every corner of the level.
struct WedgeSource
{
    std::vector<Triangle> labels;  ///< By slot the source's wedges.
    std::vector<std::uint32_t>
        number_of;  ///< By source wedge its number in the stream, or kNoWedge.
    std::vector<std::uint32_t> label_of;  ///< By wedge of the stream that of the source.
};

/// What is known at the far end of an edge: whether it separates wedges there.
enum class FarEnd : std::uint8_t
{
    Joins,
    Separates,
    Unknown,
};

/// A level whose corners are about to get their wedges: what those who code them share.
template <typename Coder>
struct WedgeWork
{
    Coder& coder;
    const LevelMesh& mesh;
    AttributeState& state;
    WedgeSource* source;           ///< Encoder only.
    std::uint32_t old;             ///< Vertices of the level before.
    std::vector<Corner> first;     ///< By vertex where its fan begins.
    std::vector<Triangle> wedges;  ///< By slot; kNoWedge where it is not known yet.
    ItemStacks waiting;            ///< One stack of vertices, less `old`: seams go on there.

    /// Wedge at a corner.
    [[nodiscard]] std::uint32_t& wedge_at(Corner corner)
    {
        return wedges[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    }

    /// Encoder only: the source's wedge at a corner.
    [[nodiscard]] std::uint32_t label_at(Corner corner) const
    {
        return source
            ->labels[static_cast<std::size_t>(corner >> 2)][static_cast<std::size_t>(corner & 3)];
    }

    /// Encoder only: number of the wedge at a corner.
    [[nodiscard]] std::uint32_t wanted(Corner corner) const
    {
        if constexpr (Coder::kEncodes)
        {
            return source->number_of[label_at(corner)];
        }
        return kNoWedge;
    }

    /// True when a vertex of the level before has one wedge only.
    [[nodiscard]] bool is_single(std::uint32_t vertex) const
    {
        return state.next_wedge[state.first_wedge[vertex]] == kNoWedge;
    }

    /// Looks at the edge between a corner of a fan and the next one, at its far end.
    [[nodiscard]] FarEnd far_end(Corner corner)
    {
        const std::uint32_t here = wedge_at(previous_corner(corner));
        const std::uint32_t there = wedge_at(previous_corner(mesh.across(next_corner(corner))));
        if (here == kNoWedge || there == kNoWedge)
        {
            return FarEnd::Unknown;
        }
        return here == there ? FarEnd::Joins : FarEnd::Separates;
    }

    /// Puts the vertex at the far end of a seam's edge on the stack, unless it is known.
    void go_on_at(std::uint32_t vertex)
    {
        if (vertex >= old && state.first_wedge[vertex] == kNoWedge)
        {
            waiting.push(0, vertex - old, 0);
        }
    }
};

}  // namespace vsplit::codec
