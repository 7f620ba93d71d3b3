#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <span>

namespace vsplit {

/// The cubic lattice that positions are rounded to: point = origin + index * cell, per axis.
struct QuantizationGrid
{
    std::array<double, 3> origin{};  ///< Smallest corner of the bounding box, model units.
    double cell = 1.0;               ///< Edge of a cell, model units, > 0.
    int bits = 12;                   ///< Bits per coordinate, 8 .. 20.

    /// Largest index per axis, 2^bits - 1.
    [[nodiscard]] std::int32_t max_index() const { return (std::int32_t{1} << bits) - 1; }
};

/// Builds the grid whose 2^bits - 1 cells span the largest extent of the bounding box.
/// `positions`: V points, model units, all finite, V > 0; `bits`: 8 .. 20.
/// The cell is rounded up to a binary32, which headers store in half the space. A single point (or
/// coincident points) gives a cell of 1.
[[nodiscard]] QuantizationGrid make_grid(
    std::span<const std::array<double, 3>> positions, int bits
);

/// Rounds a point to the nearest grid index per axis, clamped to the grid.
[[nodiscard]] std::array<std::int32_t, 3> quantize(
    const QuantizationGrid& grid, const std::array<double, 3>& point
);

/// Returns the point that a grid index stands for when its lowest `shift` bits are unknown: the
/// centre of the 2^shift cells. With shift 0 this is exactly origin + index * cell.
/// `index`: per axis, in units of 2^shift cells.
[[nodiscard]] std::array<double, 3> dequantize(
    const QuantizationGrid& grid, const std::array<std::int32_t, 3>& index, int shift = 0
);

/// Quantises every vertex of a mesh; triangles are copied unchanged.
[[nodiscard]] GridMesh quantize(const QuantizationGrid& grid, const IndexedMesh& mesh);

/// Turns a grid mesh back into model units.
[[nodiscard]] IndexedMesh dequantize(const QuantizationGrid& grid, const GridMesh& mesh);

}  // namespace vsplit
