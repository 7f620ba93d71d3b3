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
};

/// A level to place.
struct PlacedLevel
{
    std::size_t level = 0;
    int shift = 0;
    std::vector<Triangle> triangles;  ///< In vertices of the source.
    /// Vertices that may be moved: those that the level adds; empty for all, where the level has another
    /// shift than the one before.
    std::vector<std::uint32_t> free;
};

/// Says whether a level of `vertices` out of `all` is worth placing at `shift`: what the vertices
/// cost on their way home is felt in the size of the file when they are many.
[[nodiscard]] bool is_worth_placing(std::size_t vertices, std::size_t all, int shift);

/// Decides where levels show their vertices: in the cells from which the surface follows the source
/// best, at a price for leaving the cell that a vertex comes from or belongs to.
/// `levels`: coarsest first, shifts falling; `threads`: at least 1, the result does not depend on it.
/// Result: for each of them the vertices that from there on are not shown in their own cells.
/// Cost: about ten microseconds for every free vertex.
[[nodiscard]] std::vector<std::vector<codec::Displacement>> place_levels(
    const PlacementSource& source, std::span<const PlacedLevel> levels, unsigned threads
);

}  // namespace vsplit::precompute
