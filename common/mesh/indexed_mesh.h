#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vsplit {

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A triangle mesh in model units.
struct IndexedMesh
{
    std::vector<std::array<double, 3>> positions;
    std::vector<Triangle> triangles;
};

/// A triangle mesh whose positions are integers on a QuantizationGrid, each in 0 .. 2^bits - 1.
struct GridMesh
{
    std::vector<std::array<std::int32_t, 3>> positions;
    std::vector<Triangle> triangles;
};

}  // namespace vsplit
