#pragma once

#include "precompute/collapse_mesh.h"

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace vsplit::test {

/// Two vertices, the smaller one first.
using Edge = std::array<std::uint32_t, 2>;

/// What a level looks like: everything by face of the complete mesh.
struct Level
{
    std::map<std::uint32_t, Triangle> triangles;
    std::map<std::uint32_t, Triangle> wedges;
};

/// Copies what a mesh with wedges shows.
[[nodiscard]] Level level_of(const precompute::CollapseMesh& mesh);

/// What a contraction must not change.
struct Charts
{
    std::map<std::uint32_t, std::uint32_t> of_face;
    std::set<Edge> seams;
    std::map<std::uint32_t, std::set<std::uint32_t>> wedges_of;  ///< By vertex.

    /// By chart, cut open along its seams: wedges - edges + faces.
    std::map<std::uint32_t, int> euler;
    std::set<Edge> neighbours;  ///< Pairs of charts with a seam between them.
    int seam_euler = 0;         ///< Vertices - edges of the seams.
    std::size_t seam_parts = 0;
};

/// Finds charts and seams. `names`: by face the chart in the complete mesh, if that is known; else charts
/// get the number of their first face. Expects that no chart fell apart and none were joined.
[[nodiscard]] Charts find_charts(const Level& level, const Charts* names);

/// Compares a level with the complete mesh. `target`: where vertices of the complete mesh went.
void expect_contraction(
    const precompute::CollapseMesh& mesh,
    const Charts& whole,
    const std::vector<std::uint32_t>& target
);

}  // namespace vsplit::test
