#include "precompute/level_builder.h"

#include "codec/shapes.h"
#include "codec/stream_encoder.h"
#include "codec/stream_parts.h"
#include "mesh/quantization_grid.h"
#include "precompute/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace vsplit::test {
namespace {

using codec::Collapse;
using codec::SplitKind;
using precompute::CollapseCost;
using precompute::CollapseMesh;
using precompute::LevelBuilder;
using precompute::LevelStyle;
using precompute::Metric;
using precompute::OneRing;

/// What a sequence of levels is made of, finest first.
struct Sequence
{
    GridMesh mesh;
    QuantizationGrid grid;
    std::vector<std::vector<Collapse>> levels;
    std::vector<std::vector<Triangle>> triangles;  ///< Before each level and after the last.
};

Sequence make_sequence(
    const IndexedMesh& shape,
    const LevelStyle& style,
    std::size_t count,
    const std::vector<std::uint8_t>& locked = {},
    std::size_t most = 100000
)
{
    const IndexedMesh mesh = precompute::repair_mesh(shape)->mesh;
    Sequence sequence;
    sequence.grid = make_grid(mesh.positions, 12);
    sequence.mesh = quantize(sequence.grid, mesh);
    std::vector<precompute::Vector3> exact;
    for (const auto& [x, y, z] : sequence.mesh.positions)
    {
        exact.push_back({1.0 * x, 1.0 * y, 1.0 * z});
    }
    CollapseMesh working(static_cast<std::uint32_t>(exact.size()), mesh.triangles);
    CollapseCost cost(Metric::Qem, exact, working, {});
    LevelBuilder builder(working, cost, exact, locked);
    sequence.triangles.push_back(mesh.triangles);
    for (std::size_t level = 0; level < count; ++level)
    {
        auto collapses = builder.next_level(style, most);
        if (collapses.empty())
        {
            break;
        }
        EXPECT_EQ(builder.vertex_count(), working.vertices().size());
        sequence.levels.push_back(std::move(collapses));
        sequence.triangles.push_back(working.triangles());
    }
    return sequence;
}

const LevelStyle kRegular{
    .cost_weight = 1.0,
    .shape = 20.0,
    .centring = 10.0,
    .apex = 2.0,
    .packing = 2.0,
    .cheapest_share = 0.85,
    .largest_share = 1.0,
};

std::vector<IndexedMesh> shapes()
{
    return {
        torus(20, 12, 0.05, 1),
        sphere(12, 13, 0.05, 2),
        strip(30),
        height_field(14, 13, 0.4, 3),
        with_holes(height_field(18, 15, 0.4, 4), 0.08, 5),
        joined(double_cone(60), torus(10, 8, 0.1, 6), 3.0),
    };
}

TEST(LevelBuilder, RemovesVerticesWhoseStarsAreDisjoint)
{
    for (const IndexedMesh& shape : shapes())
    {
        const Sequence sequence = make_sequence(shape, kRegular, 8);
        ASSERT_GT(sequence.levels.size(), 1U);
        for (std::size_t level = 0; level < sequence.levels.size(); ++level)
        {
            std::set<std::uint32_t> removed;
            for (const Collapse& collapse : sequence.levels[level])
            {
                EXPECT_TRUE(removed.insert(collapse.removed).second);
            }
            for (const Triangle& t : sequence.triangles[level])
            {
                EXPECT_LE(removed.count(t[0]) + removed.count(t[1]) + removed.count(t[2]), 1U);
            }
        }
    }
}

TEST(LevelBuilder, MovesEveryRemovedVertexToItsKeptOne)
{
    for (const IndexedMesh& shape : shapes())
    {
        const Sequence sequence = make_sequence(shape, {}, 8);
        for (std::size_t level = 0; level < sequence.levels.size(); ++level)
        {
            // Independent collapses can be carried out at once, by renaming.
            std::vector<std::uint32_t> target(sequence.mesh.positions.size());
            for (std::uint32_t v = 0; v < target.size(); ++v)
            {
                target[v] = v;
            }
            for (const Collapse& collapse : sequence.levels[level])
            {
                target[collapse.removed] = collapse.kept;
            }
            GridMesh folded{sequence.mesh.positions, {}};
            for (Triangle t : sequence.triangles[level])
            {
                std::ranges::transform(t, t.begin(), [&](std::uint32_t v) { return target[v]; });
                if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
                {
                    folded.triangles.push_back(t);
                }
            }
            const GridMesh coarse{sequence.mesh.positions, sequence.triangles[level + 1]};
            EXPECT_EQ(face_set(folded), face_set(coarse));
        }
    }
}

TEST(LevelBuilder, RemovesAsManyAsItIsToldAndNoMore)
{
    const IndexedMesh shape = torus(30, 20, 0.05, 1);
    EXPECT_EQ(make_sequence(shape, {}, 1, {}, 7).levels[0].size(), 7U);
    EXPECT_EQ(make_sequence(shape, {.largest_share = 0.1}, 1).levels[0].size(), 60U);
    EXPECT_EQ(make_sequence(shape, {.largest_share = 0.0}, 1).levels[0].size(), 1U);
    EXPECT_GT(make_sequence(shape, kRegular, 1).levels[0].size(), 100U);
}

TEST(LevelBuilder, NeverRemovesLockedVertices)
{
    const IndexedMesh shape = torus(20, 12, 0.05, 1);
    std::vector<std::uint8_t> locked(shape.positions.size(), 0);
    for (std::size_t v = 0; v < locked.size(); v += 3)
    {
        locked[v] = 1;
    }
    const Sequence sequence = make_sequence(shape, {}, 20, locked);
    std::size_t removed = 0;
    for (const auto& level : sequence.levels)
    {
        for (const Collapse& collapse : level)
        {
            EXPECT_EQ(locked[collapse.removed], 0);
            ++removed;
        }
    }
    EXPECT_GT(removed, 50U);
}

TEST(LevelBuilder, RemovesNothingFromATetrahedron)
{
    EXPECT_TRUE(make_sequence(tetrahedron(), {}, 3).levels.empty());
    EXPECT_TRUE(make_sequence(triangle(), {}, 3).levels.empty());
}

TEST(DescribeCollapse, NamesTheEndsOfTheWedge)
{
    const IndexedMesh shape = fan(6);
    const CollapseMesh mesh(7, shape.triangles);
    OneRing ring;
    ASSERT_TRUE(mesh.ring(0, ring));
    const Collapse inner = precompute::describe_collapse(0, ring, 2);
    EXPECT_EQ(inner.kept, ring.vertex[2]);
    EXPECT_EQ(inner.right, ring.vertex[3]);
    EXPECT_EQ(inner.wedge, 4);
    EXPECT_EQ(inner.kind, SplitKind::Interior);
    ASSERT_TRUE(mesh.ring(3, ring));
    const Collapse left = precompute::describe_collapse(3, ring, 0);
    EXPECT_EQ(left.kind, SplitKind::BoundaryLeft);
    EXPECT_EQ(left.kept, ring.vertex[0]);
    EXPECT_EQ(left.right, ring.vertex[1]);
    EXPECT_EQ(left.wedge, 1);
    const Collapse right = precompute::describe_collapse(3, ring, 2);
    EXPECT_EQ(right.kind, SplitKind::BoundaryRight);
    EXPECT_EQ(right.kept, ring.vertex[2]);
    EXPECT_EQ(right.right, ring.vertex[0]);
}

/// Codes a sequence and compares every level that the decoder shows with the one that was coded.
/// `per_level`: batches that share a level.
void expect_replay(Sequence sequence, std::size_t per_level)
{
    std::ranges::reverse(sequence.levels);
    std::ranges::reverse(sequence.triangles);
    codec::StreamPlan plan;
    plan.grid = sequence.grid;
    plan.mesh = &sequence.mesh;
    plan.base_triangles = sequence.triangles.front();
    plan.levels.emplace_back();
    std::vector<std::size_t> shown{0};  // by level the number of batches undone
    for (std::size_t i = 0; i < sequence.levels.size(); ++i)
    {
        if (i % per_level == 0)
        {
            plan.levels.emplace_back();
            shown.push_back(i);
        }
        plan.levels.back().batches.push_back(sequence.levels[i]);
        ++shown.back();
    }
    for (std::size_t level = 0; level < plan.levels.size(); ++level)
    {
        const std::size_t later = plan.levels.size() - 1 - level;
        plan.levels[level].shift = static_cast<int>(std::min<std::size_t>(later, 5));
    }
    plan.grow_last_level = false;
    const auto file = codec::encode_stream(plan);
    ASSERT_TRUE(file.has_value()) << describe(file.error());
    const Decoded decoded = decode(*file);
    ASSERT_FALSE(decoded.error.has_value()) << describe(*decoded.error);
    ASSERT_EQ(decoded.levels.size(), plan.levels.size());
    for (std::size_t level = 0; level < shown.size(); ++level)
    {
        SCOPED_TRACE(level);
        const int shift = plan.levels[level].shift;
        EXPECT_EQ(decoded.levels[level].shift, shift);
        GridMesh wanted{sequence.mesh.positions, sequence.triangles[shown[level]]};
        for (auto& position : wanted.positions)
        {
            std::ranges::transform(position, position.begin(), [&](int x) { return x >> shift; });
        }
        ASSERT_EQ(face_set(decoded.levels[level].mesh), face_set(wanted));
    }
}

TEST(Replay, ShowsEveryLevelThatWasCoded)
{
    for (const IndexedMesh& shape : shapes())
    {
        for (const std::size_t per_level : {1U, 3U, 8U})
        {
            expect_replay(make_sequence(shape, kRegular, 30), per_level);
            expect_replay(make_sequence(shape, {.largest_share = 0.1}, 30), per_level);
        }
    }
}

TEST(Replay, WorksWithOneSplitALevel)
{
    expect_replay(make_sequence(torus(8, 6, 0.1, 3), {.largest_share = 0.0}, 40), 1);
}

}  // namespace
}  // namespace vsplit::test
