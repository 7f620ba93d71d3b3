#include "codec/shapes.h"
#include "precompute/collapse_cost.h"
#include "precompute/collapse_mesh.h"
#include "precompute/level_builder.h"
#include "textured_shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>

namespace vsplit::test {
namespace {

using codec::SeamRecord;
using precompute::CollapseCost;
using precompute::CollapseMesh;
using precompute::LevelBuilder;
using precompute::LevelStyle;
using precompute::Metric;
using precompute::OneRing;

using Edge = std::array<std::uint32_t, 2>;

/// What a level looks like: everything by face of the complete mesh.
struct Level
{
    std::map<std::uint32_t, Triangle> triangles;
    std::map<std::uint32_t, Triangle> wedges;
};

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

/// `names`: by face the chart in the complete mesh, if that is known; else charts get the number of
/// their first face.
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

/// Compares a level with the complete mesh. `target`: where vertices of the complete mesh went.
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

/// Undoes a collapse in what is left to do of the finer level, by its record alone.
void expect_record(
    const codec::Collapse& collapse,
    const SeamRecord& record,
    const Level& fine,
    const Level& coarse
)
{
    const bool has_right = record.faces[0] != SeamRecord::kNoFace;
    const bool has_left = record.faces[1] != SeamRecord::kNoFace;
    EXPECT_EQ(has_right, collapse.kind != codec::SplitKind::BoundaryRight);
    EXPECT_EQ(has_left, collapse.kind != codec::SplitKind::BoundaryLeft);
    std::map<std::uint32_t, std::uint32_t> passes_to;  // by wedge of the kept vertex
    for (std::size_t side = 0; side < 2; ++side)
    {
        const std::uint32_t face = record.faces[side];
        if (face == SeamRecord::kNoFace)
        {
            EXPECT_EQ(record.wedges[side], SeamRecord{}.wedges[side]);
            continue;
        }
        ASSERT_TRUE(fine.triangles.contains(face));
        EXPECT_FALSE(coarse.triangles.contains(face));
        const Triangle& t = fine.triangles.at(face);
        const auto first =
            static_cast<std::size_t>(std::ranges::find(t, collapse.kept) - t.begin());
        const std::size_t removed_at = side == 0 ? 2 : 1;
        ASSERT_LT(first, 3U);
        EXPECT_EQ(t[(first + removed_at) % 3], collapse.removed);
        for (std::size_t k = 0; k < 3; ++k)
        {
            EXPECT_EQ(record.wedges[side][k], fine.wedges.at(face)[(first + k) % 3]);
        }
        passes_to[record.wedges[side][0]] = record.wedges[side][removed_at];
    }
    for (const auto& [face, t] : coarse.triangles)
    {
        const Triangle& before = fine.triangles.at(face);
        const auto at =
            static_cast<std::size_t>(std::ranges::find(before, collapse.removed) - before.begin());
        if (at < 3)
        {
            EXPECT_EQ(t[at], collapse.kept);
            ASSERT_TRUE(passes_to.contains(coarse.wedges.at(face)[at]));
            EXPECT_EQ(passes_to[coarse.wedges.at(face)[at]], fine.wedges.at(face)[at]);
        }
    }
}

std::vector<std::uint32_t> identity(std::size_t count)
{
    std::vector<std::uint32_t> target(count);
    std::iota(target.begin(), target.end(), 0U);
    return target;
}

void send_to(std::vector<std::uint32_t>& target, std::uint32_t removed, std::uint32_t kept)
{
    std::ranges::replace(target, removed, kept);
}

CollapseMesh working(const TexturedShape& shape)
{
    return CollapseMesh(
        static_cast<std::uint32_t>(shape.mesh.positions.size()),
        shape.mesh.triangles,
        shape.wedges.corners
    );
}

/// Makes levels until nothing goes any more, checking each. Result: the vertices left.
std::size_t expect_levels(const TexturedShape& shape)
{
    const auto grid = make_grid(shape.mesh.positions, 12);
    std::vector<precompute::Vector3> exact;
    for (const auto& [x, y, z] : quantize(grid, shape.mesh).positions)
    {
        exact.push_back({1.0 * x, 1.0 * y, 1.0 * z});
    }
    CollapseMesh mesh = working(shape);
    CollapseCost cost(Metric::Qem, exact, mesh, {});
    LevelBuilder builder(mesh, cost, exact, {});
    Level fine = level_of(mesh);
    const Charts whole = find_charts(fine, nullptr);
    auto target = identity(exact.size());
    for (;;)
    {
        const auto batch = builder.next_level({.largest_share = 1.0}, 100000);
        const auto seams = builder.take_seams();
        EXPECT_EQ(batch.size(), seams.size());
        if (batch.empty() || ::testing::Test::HasFailure())
        {
            return builder.vertex_count();
        }
        const Level coarse = level_of(mesh);
        for (std::size_t i = 0; i < batch.size(); ++i)
        {
            send_to(target, batch[i].removed, batch[i].kept);
            expect_record(batch[i], seams[i], fine, coarse);
        }
        expect_contraction(mesh, whole, target);
        fine = coarse;
    }
}

TEST(CollapseSeams, ContractsSeamsAndChartsAtEveryLevel)
{
    for (const TexturedShape& shape : textured_shapes())
    {
        SCOPED_TRACE(shape.name);
        const std::size_t left = expect_levels(shape);
        if (shape.name.find("slit") == std::string::npos &&
            shape.name.find("split") == std::string::npos)
        {
            EXPECT_LT(left, shape.mesh.positions.size() / 3);
        }
        ASSERT_FALSE(HasFailure());
    }
}

TEST(CollapseSeams, ContractsSeamsWhateverTheOrder)
{
    for (const TexturedShape& shape : textured_shapes())
    {
        SCOPED_TRACE(shape.name);
        const auto count = static_cast<std::uint32_t>(shape.mesh.positions.size());
        CollapseMesh mesh = working(shape);
        const Charts whole = find_charts(level_of(mesh), nullptr);
        auto target = identity(count);
        std::mt19937 random(7);
        std::size_t done = 0;
        for (std::uint32_t attempt = 0; attempt < 20 * count; ++attempt)
        {
            const auto v = static_cast<std::uint32_t>(random() % count);
            OneRing ring;
            if (mesh.is_removed(v) || !mesh.ring(v, ring) || ring.size < 3)
            {
                continue;
            }
            std::size_t kept = random() % ring.size;
            kept = ring.boundary ? (kept % 2 == 0 ? 0 : ring.size - 1) : kept;
            if (mesh.can_collapse(v, ring, kept, 12))
            {
                send_to(target, v, ring.vertex[kept]);
                mesh.collapse(v, ring, kept);
                ++done;
            }
            if (done % 20 == 1)
            {
                expect_contraction(mesh, whole, target);
                ++done;
            }
            ASSERT_FALSE(HasFailure());
        }
        expect_contraction(mesh, whole, target);
    }
}

TEST(CollapseSeams, ChangesNothingWhereEveryVertexHasOneWedge)
{
    const TexturedShape shape = textured("torus", torus(20, 12, 0.05, 1), 1, 0.0, 1);
    CollapseMesh with = working(shape);
    CollapseMesh without(
        static_cast<std::uint32_t>(shape.mesh.positions.size()), shape.mesh.triangles
    );
    EXPECT_TRUE(with.has_wedges());
    EXPECT_FALSE(without.has_wedges());
    EXPECT_TRUE(without.wedges().empty());
    for (std::uint32_t v = 0; v < shape.mesh.positions.size(); ++v)
    {
        OneRing ring;
        ASSERT_TRUE(with.ring(v, ring));
        for (std::size_t kept = 0; kept < ring.size; ++kept)
        {
            EXPECT_EQ(
                with.can_collapse(v, ring, kept, 24), without.can_collapse(v, ring, kept, 24)
            );
        }
    }
}

TEST(CollapseSeams, KeepsASlitOfTwoEdges)
{
    // One vertex of a torus has two values; the seam between them ends at two of its neighbours.
    TexturedShape shape = textured("torus", torus(12, 9, 0.0, 0), 1, 0.0, 0);
    const CollapseMesh plain = working(shape);
    OneRing ring;
    ASSERT_TRUE(plain.ring(40, ring));
    std::vector<Triangle> values = shape.mesh.triangles;
    for (const std::size_t i : {0U, 1U, 2U})
    {
        const auto corner = static_cast<std::size_t>(ring.corner[i]);
        values[corner >> 2][corner & 3] = 1000;
    }
    const std::vector<std::span<const Triangle>> tables{values};
    shape.wedges = precompute::split_wedges(shape.mesh, tables, {});
    EXPECT_EQ(shape.wedges.count, shape.mesh.positions.size() + 1);
    const CollapseMesh mesh = working(shape);
    for (std::size_t kept = 0; kept < ring.size; ++kept)
    {
        EXPECT_FALSE(mesh.can_collapse(40, ring, kept, 24)) << kept;
    }
    // Its ends go anywhere but along the slit.
    OneRing end;
    ASSERT_TRUE(mesh.ring(ring.vertex[0], end));
    for (std::size_t kept = 0; kept < end.size; ++kept)
    {
        const bool along = end.vertex[kept] == 40 || end.vertex[kept] == ring.vertex[3];
        EXPECT_EQ(mesh.can_collapse(ring.vertex[0], end, kept, 24), !along) << kept;
    }
}

}  // namespace
}  // namespace vsplit::test
