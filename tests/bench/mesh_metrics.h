#pragma once

#include "mesh/indexed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vsplit::bench {

/// The positions of a mesh in single precision.
[[nodiscard]] inline std::vector<std::array<float, 3>> to_floats(const IndexedMesh& mesh)
{
    std::vector<std::array<float, 3>> positions;
    positions.reserve(mesh.positions.size());
    for (const auto& p : mesh.positions)
    {
        positions.push_back(
            {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}
        );
    }
    return positions;
}

/// Length of the bounding box's diagonal. Precondition: at least one vertex.
[[nodiscard]] inline double diagonal(const IndexedMesh& mesh)
{
    double squares = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto [low, high] = std::ranges::minmax_element(
            mesh.positions, {}, [k](const auto& position) { return position[k]; }
        );
        squares += std::pow((*high)[k] - (*low)[k], 2);
    }
    return std::sqrt(squares);
}

}  // namespace vsplit::bench
