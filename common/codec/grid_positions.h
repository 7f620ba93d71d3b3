#pragma once

#include "codec/stream_encoder.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Where the vertices of a plan are on the grid of one of its levels. Not thread safe.
class GridPositions
{
public:
    /// `mesh`: the plan's, which must outlive the object.
    explicit GridPositions(const GridMesh& mesh) : mesh_(mesh) {}

    /// Goes to the first level or the next one. `changed`: its shift is another than the last one's.
    void enter(const PlannedLevel& level, bool changed)
    {
        if (changed)
        {
            cells_ = mesh_.positions;
            for (auto& cell : cells_)
            {
                cell = {cell[0] >> level.shift, cell[1] >> level.shift, cell[2] >> level.shift};
            }
        }
        for (const Displacement& displacement : level.displaced)
        {
            cells_[displacement.vertex] = displacement.position;
        }
    }

    /// Position of a vertex of the plan.
    [[nodiscard]] const std::array<std::int32_t, 3>& operator[](std::uint32_t vertex) const
    {
        return cells_[vertex];
    }

    /// Positions of several vertices.
    [[nodiscard]] std::vector<std::array<std::int32_t, 3>> of(
        std::span<const std::uint32_t> vertices
    ) const
    {
        std::vector<std::array<std::int32_t, 3>> result;
        result.reserve(vertices.size());
        for (const std::uint32_t vertex : vertices)
        {
            result.push_back(cells_[vertex]);
        }
        return result;
    }

private:
    const GridMesh& mesh_;
    std::vector<std::array<std::int32_t, 3>> cells_;
};

/// A base mesh and by its vertices those of the plan.
struct CollectedBase
{
    GridMesh mesh;
    std::vector<std::uint32_t> sources;
};

/// Collects the vertices of triangles, by index in the plan, in the order in which they occur.
[[nodiscard]] inline CollectedBase collect_base(
    std::span<const Triangle> triangles, const GridPositions& on_grid
)
{
    CollectedBase base;
    std::map<std::uint32_t, std::uint32_t> place;
    for (Triangle triangle : triangles)
    {
        for (std::uint32_t& v : triangle)
        {
            const auto [found, is_new] = place.try_emplace(v, base.sources.size());
            if (is_new)
            {
                base.sources.push_back(v);
                base.mesh.positions.push_back(on_grid[v]);
            }
            v = found->second;
        }
        base.mesh.triangles.push_back(triangle);
    }
    return base;
}

}  // namespace vsplit::codec
