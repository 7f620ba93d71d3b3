#pragma once

#include "codec/stream_encoder.h"
#include "mesh/closest_point_tree.h"
#include "mesh/indexed_mesh.h"
#include "precompute/collapse_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// The complete mesh that levels are placed for.
struct PlacementSource
{
    std::span<const Vector3> exact;          ///< V points, grid units, not rounded.
    const GridMesh* mesh = nullptr;          ///< The same on the grid.
    const ClosestPointTree* tree = nullptr;  ///< Of both.
    std::span<const std::uint8_t> locked;    ///< V flags: vertices that stay at home; or empty.
    int bits = 12;                           ///< Position bits.
    int late_bits = 0;                       ///< Bits that only the last level has.
    /// By vertex the number of its component, when levels may lack some; or empty.
    std::span<const std::uint32_t> components{};
};

/// Levels of one shift, to be placed together.
struct PlacedLevels
{
    std::size_t coarsest_level = 0;
    int shift = 0;
    std::vector<Triangle> finest;     ///< Of the finest level, in vertices of the source.
    std::vector<Triangle> coarsest;   ///< Of the coarsest; empty when it is the finest.
    std::vector<std::uint32_t> born;  ///< Vertices that no level before has, among others maybe.
};

/// Says whether a level of `vertices` out of `all` is worth placing at `shift`: what the vertices
/// cost on their way home is felt in the size of the file when they are many.
[[nodiscard]] bool is_worth_placing(std::size_t vertices, std::size_t all, int shift);

/// Decides where levels show their vertices: in the cells from which the surface follows the source
/// best, at a price for leaving the cell that a vertex comes from or belongs to.
/// `levels`: coarsest first, shifts falling; `threads`: at least 1, the result does not depend on it.
/// Result: for each of them the vertices that from there on are not shown in their own cells.
/// Cost: about ten microseconds for every vertex of a finest level.
[[nodiscard]] std::vector<std::vector<codec::Displacement>> place_levels(
    const PlacementSource& source, std::span<const PlacedLevels> levels, unsigned threads
);

}  // namespace vsplit::precompute
