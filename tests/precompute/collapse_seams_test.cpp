#include "codec/shapes.h"
#include "level_charts.h"
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
