#include "level_charts.h"

#include "precompute/wedges.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vsplit::test {
namespace {

using precompute::CollapseMesh;

/// An edge seen from a face: the face and the wedges at the smaller and the larger vertex.
struct Side
{
    std::uint32_t face = 0;
    Edge wedges{};
};

std::map<Edge, std::vector<Side>> edges_of(const Level& level)
{
    std::map<Edge, std::vector<Side>> edges;
    for (const auto& [face, t] : level.triangles)
    {
        const Triangle& w = level.wedges.at(face);
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::size_t a = t[k] < t[(k + 1) % 3] ? k : (k + 1) % 3;
            const std::size_t b = a == k ? (k + 1) % 3 : k;
            edges[{t[a], t[b]}].push_back({face, {w[a], w[b]}});
        }
    }
    return edges;
}

/// Joins what touches; the least number stands for the set.
class Sets
{
public:
    std::uint32_t find(std::uint32_t x)
    {
        const auto at = parent_.emplace(x, x).first->second;
        return at == x ? x : find(at);
    }

    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    std::size_t count()
    {
        return static_cast<std::size_t>(std::ranges::count_if(parent_, [](const auto& entry) {
            return entry.first == entry.second;
        }));
    }

private:
    std::map<std::uint32_t, std::uint32_t> parent_;
};

/// The number of sets of corners that belong together: as many as there are wedges, if each is a sector.
void expect_sectors(const Level& level, const std::map<std::uint32_t, std::set<std::uint32_t>>& of)
{
    // Numbered without gaps, as split_wedges() wants vertices.
    std::map<std::uint32_t, std::uint32_t> number;
    for (const auto& [vertex, wedges] : of)
    {
        number.emplace(vertex, static_cast<std::uint32_t>(number.size()));
    }
    IndexedMesh packed;
    packed.positions.resize(number.size());
    std::vector<Triangle> table;
    for (const auto& [face, t] : level.triangles)
    {
        packed.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
        table.push_back(level.wedges.at(face));
    }
    const std::vector<std::span<const Triangle>> tables{table};
    const auto wedges = precompute::split_wedges(packed, tables, {});
    std::map<std::uint32_t, std::uint32_t> sector_of;
    std::map<std::uint32_t, std::uint32_t> wedge_of;
    for (std::size_t f = 0; f < table.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::uint32_t sector = wedges.corners[f][k];
            EXPECT_EQ(sector_of.emplace(table[f][k], sector).first->second, sector);
            EXPECT_EQ(wedge_of.emplace(sector, table[f][k]).first->second, table[f][k]);
        }
    }
}

}  // namespace

Level level_of(const CollapseMesh& mesh)
{
    const auto faces = mesh.faces();
    const auto triangles = mesh.triangles();
    const auto wedges = mesh.wedges();
    EXPECT_EQ(faces.size(), triangles.size());
    EXPECT_EQ(faces.size(), wedges.size());
    Level level;
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        level.triangles[faces[i]] = triangles[i];
        level.wedges[faces[i]] = wedges[i];
    }
    return level;
}

Charts find_charts(const Level& level, const Charts* names)
{
    Charts charts;
    Sets faces;
    Sets seam_vertices;
    const auto edges = edges_of(level);
    for (const auto& [edge, sides] : edges)
    {
        if (sides.size() == 2 && sides[0].wedges == sides[1].wedges)
        {
            faces.join(sides[0].face, sides[1].face);
        }
        else if (sides.size() == 2)
        {
            charts.seams.insert(edge);
            seam_vertices.join(edge[0], edge[1]);
        }
    }
    std::map<std::uint32_t, std::set<std::uint32_t>> chart_wedges;
    std::map<std::uint32_t, std::uint32_t> name_of;
    for (const auto& [face, t] : level.triangles)
    {
        const std::uint32_t part = faces.find(face);
        const std::uint32_t name = names != nullptr ? names->of_face.at(face) : part;
        // Connected in this level is what was connected before, and nothing else.
        EXPECT_EQ(name_of.emplace(part, name).first->second, name);
        charts.of_face[face] = name;
        ++charts.euler[name];
        for (std::size_t k = 0; k < 3; ++k)
        {
            charts.wedges_of[t[k]].insert(level.wedges.at(face)[k]);
            chart_wedges[name].insert(level.wedges.at(face)[k]);
        }
    }
    EXPECT_EQ(name_of.size(), charts.euler.size()) << "a chart fell apart";
    for (const auto& [edge, sides] : edges)
    {
        --charts.euler[charts.of_face[sides[0].face]];
        if (charts.seams.contains(edge))
        {
            --charts.euler[charts.of_face[sides[1].face]];
            const auto [a, b] =
                std::minmax(charts.of_face[sides[0].face], charts.of_face[sides[1].face]);
            charts.neighbours.insert({a, b});
        }
    }
    for (const auto& [chart, wedges] : chart_wedges)
    {
        charts.euler[chart] += static_cast<int>(wedges.size());
    }
    std::set<std::uint32_t> vertices;
    for (const Edge& edge : charts.seams)
    {
        vertices.insert(edge.begin(), edge.end());
    }
    charts.seam_euler = static_cast<int>(vertices.size()) - static_cast<int>(charts.seams.size());
    charts.seam_parts = seam_vertices.count();
    return charts;
}

void expect_contraction(
    const CollapseMesh& mesh, const Charts& whole, const std::vector<std::uint32_t>& target
)
{
    const Level level = level_of(mesh);
    const Charts charts = find_charts(level, &whole);
    EXPECT_EQ(charts.euler, whole.euler);
    EXPECT_EQ(charts.neighbours, whole.neighbours);
    EXPECT_EQ(charts.seam_euler, whole.seam_euler);
    EXPECT_EQ(charts.seam_parts, whole.seam_parts);
    std::set<Edge> contracted;
    std::set<std::uint32_t> on_seam;
    for (const Edge& edge : whole.seams)
    {
        const auto [a, b] = std::minmax(target[edge[0]], target[edge[1]]);
        on_seam.insert({a, b});
        if (a != b)
        {
            contracted.insert({a, b});
        }
    }
    EXPECT_EQ(charts.seams, contracted);
    for (const auto& [vertex, wedges] : charts.wedges_of)
    {
        EXPECT_EQ(wedges, whole.wedges_of.at(vertex)) << "vertex " << vertex;
        EXPECT_EQ(mesh.is_on_seam(vertex), on_seam.contains(vertex)) << "vertex " << vertex;
    }
    expect_sectors(level, charts.wedges_of);
}

}  // namespace vsplit::test
