#include "precompute/cut_copies.h"

#include "codec/shapes.h"
#include "precompute/level_builder.h"
#include "precompute/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace vsplit::test {
namespace {

using precompute::CollapseCost;
using precompute::CollapseMesh;
using precompute::CopyStars;
using precompute::CutCopies;
using precompute::LevelBuilder;
using precompute::Metric;
using precompute::RepairedMesh;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Edge = std::array<std::uint32_t, 2>;

constexpr std::uint32_t kMostNeighbours = 6;

/// A band of `around` * `across` vertices that is turned over once.
IndexedMesh moebius(std::uint32_t around, std::uint32_t across)
{
    IndexedMesh mesh;
    for (std::uint32_t i = 0; i < around; ++i)
    {
        const double angle = 6.283185307179586 * i / around;
        for (std::uint32_t j = 0; j < across; ++j)
        {
            const double off = 0.6 * j / (across - 1.0) - 0.3;
            const double radius = 1.0 + off * std::cos(angle / 2);
            mesh.positions.push_back(
                {radius * std::cos(angle), radius * std::sin(angle), off * std::sin(angle / 2)}
            );
        }
    }
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) {
        return i < around ? i * across + j : across - 1 - j;
    };
    for (std::uint32_t i = 0; i < around; ++i)
    {
        for (std::uint32_t j = 0; j + 1 < across; ++j)
        {
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
            mesh.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    return mesh;
}

/// A mesh with more triangles between its vertices, some of which share an edge with two others.
IndexedMesh with_flaps(IndexedMesh mesh, std::size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    const std::size_t faces = mesh.triangles.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        const Triangle& at = mesh.triangles[random() % faces];
        const auto tip = static_cast<std::uint32_t>(random() % mesh.positions.size());
        mesh.triangles.push_back({at[0], at[1], tip});
    }
    return mesh;
}

std::vector<IndexedMesh> cut_shapes()
{
    return {
        book(6),
        book(12),
        moebius(40, 5),
        moebius(30, 8),
        with_flaps(torus(20, 12, 0.05, 1), 10, 1),
        with_flaps(height_field(14, 13, 0.4, 3), 25, 3),
        with_flaps(book(8), 6, 5),
    };
}

/// Edges of the complete mesh as the copies at their ends, by the source vertices of these: only where
/// there are several.
std::vector<std::vector<Edge>> cut_edges(const RepairedMesh& repaired)
{
    std::map<Edge, std::set<Edge>> edges;
    for (const Triangle& t : repaired.mesh.triangles)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            const auto [x, y] = std::minmax(repaired.stitches[a], repaired.stitches[b]);
            edges[{x, y}].insert({a, b});
        }
    }
    std::vector<std::vector<Edge>> result;
    for (const auto& [source, copies] : edges)
    {
        if (copies.size() > 1)
        {
            result.emplace_back(copies.begin(), copies.end());
        }
    }
    return result;
}

/// `target`: by vertex where it went.
void expect_closed(
    const RepairedMesh& repaired,
    const std::vector<std::vector<Edge>>& cuts,
    const CollapseMesh& mesh,
    const std::vector<std::uint32_t>& target
)
{
    const auto& stitches = repaired.stitches;
    for (std::uint32_t v = 0; v < target.size(); ++v)
    {
        ASSERT_EQ(stitches[target[v]], stitches[target[stitches[v]]]) << "vertex " << v;
    }
    std::set<Edge> edges;
    for (const Triangle& t : mesh.triangles())
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            EXPECT_NE(stitches[a], stitches[b]);
            edges.insert({a, b});
        }
    }
    for (const std::vector<Edge>& cut : cuts)
    {
        std::set<Edge> sources;
        for (const auto& [a, b] : cut)
        {
            const auto [x, y] = std::minmax(target[a], target[b]);
            EXPECT_TRUE(x == y || edges.contains({x, y}));
            const auto [source, other] = std::minmax(stitches[x], stitches[y]);
            sources.insert({source, other});
        }
        EXPECT_EQ(sources.size(), 1U) << "a cut edge went different ways";
    }
}

/// Makes all levels, checking each. Result: share of the copies that is left.
double fold_all(const RepairedMesh& repaired)
{
    const IndexedMesh& mesh = repaired.mesh;
    std::vector<precompute::Vector3> exact;
    for (const auto& [x, y, z] : quantize(make_grid(mesh.positions, 12), mesh).positions)
    {
        exact.push_back({1.0 * x, 1.0 * y, 1.0 * z});
    }
    CollapseMesh working(static_cast<std::uint32_t>(exact.size()), mesh.triangles);
    CollapseCost cost(Metric::Qem, exact, working, {});
    LevelBuilder builder(working, cost, exact, {});
    builder.fold_together(repaired.stitches);
    const auto cuts = cut_edges(repaired);
    std::vector<std::uint32_t> target(exact.size());
    std::iota(target.begin(), target.end(), 0U);
    for (;;)
    {
        const auto before = working.triangles();
        const auto batch = builder.next_level({.packing = 2.0, .largest_share = 1.0}, 100000);
        std::set<std::uint32_t> removed;
        for (const codec::Collapse& collapse : batch)
        {
            removed.insert(collapse.removed);
            std::ranges::replace(target, collapse.removed, collapse.kept);
        }
        for (const Triangle& t : before)
        {
            EXPECT_LE(removed.count(t[0]) + removed.count(t[1]) + removed.count(t[2]), 1U);
        }
        expect_closed(repaired, cuts, working, target);
        if (batch.empty() || ::testing::Test::HasFailure())
        {
            break;
        }
    }
    const auto marked = precompute::mark_copies(repaired.stitches);
    const auto left = working.vertices();
    const auto copies =
        std::ranges::count_if(left, [&](std::uint32_t v) { return marked[v] != 0; });
    return static_cast<double>(copies) / static_cast<double>(std::ranges::count(marked, 1));
}

TEST(CutCopies, NeverOpenACutAtAnyLevel)
{
    for (const IndexedMesh& shape : cut_shapes())
    {
        const auto repaired = precompute::repair_mesh(shape);
        ASSERT_TRUE(repaired.has_value());
        ASSERT_FALSE(repaired->stitches.empty());
        fold_all(*repaired);
        ASSERT_FALSE(HasFailure());
    }
}

TEST(CutCopies, GoTogetherAlongACut)
{
    EXPECT_LT(fold_all(*precompute::repair_mesh(book(12))), 0.4);
    EXPECT_LT(fold_all(*precompute::repair_mesh(moebius(30, 8))), 0.6);
}

TEST(CutCopies, AreListedBySource)
{
    const std::vector<std::uint32_t> stitches{0, 1, 2, 1, 0, 0};
    CutCopies copies{stitches};
    EXPECT_THAT(copies.of(5), ElementsAre(0, 4, 5));
    EXPECT_THAT(copies.of(1), ElementsAre(1, 3));
    EXPECT_THAT(copies.of(2), IsEmpty());
    EXPECT_EQ(copies.first_of(4), 0U);
    EXPECT_EQ(copies.first_of(2), 2U);
    EXPECT_EQ(copies.source(3), 1U);
    EXPECT_THAT(precompute::mark_copies(stitches), ElementsAre(1, 1, 0, 1, 1, 1));
    EXPECT_THAT(CutCopies().of(7), IsEmpty());
    EXPECT_EQ(CutCopies().first_of(7), 7U);
}

TEST(CutCopies, AreForgottenWhenTheyAreTakenOut)
{
    const IndexedMesh shape = fan(6);
    CollapseMesh mesh(7, shape.triangles);
    const std::vector<std::uint32_t> stitches{0, 1, 2, 3, 1, 3, 3};
    CutCopies copies{stitches};
    precompute::OneRing ring;
    ASSERT_TRUE(mesh.ring(3, ring));
    mesh.collapse(3, ring, 0);
    ASSERT_TRUE(mesh.ring(1, ring));
    mesh.collapse(1, ring, 0);
    copies.forget_removed(mesh);
    EXPECT_THAT(copies.of(3), ElementsAre(5, 6));
    EXPECT_EQ(copies.first_of(6), 5U);
    EXPECT_THAT(copies.of(4), IsEmpty());
    EXPECT_EQ(copies.source(4), 1U);
}

TEST(CopyStars, AimOnlyWhereAllCanFollow)
{
    // Three sheets that share a spine of five vertices.
    const auto repaired = precompute::repair_mesh(book(4));
    const CutCopies copies(repaired->stitches);
    const CollapseMesh mesh(
        static_cast<std::uint32_t>(repaired->mesh.positions.size()), repaired->mesh.triangles
    );
    std::size_t inner = 0;
    copies.for_each([&](std::span<const std::uint32_t> list) {
        CopyStars stars;
        if (!stars.collect(mesh, copies, list.back(), kMostNeighbours))
        {
            return;
        }
        ASSERT_EQ(stars.count, list.size());
        std::size_t targets = 0;
        for (std::size_t k = 0; k < stars.ring[0].size; ++k)
        {
            const std::uint32_t target = stars.ring[0].vertex[k];
            const bool is_cut = !copies.of(target).empty();
            EXPECT_EQ(stars.aim_at(copies, target), is_cut);
            targets += is_cut ? 1 : 0;
        }
        inner += targets == 2 ? 1 : 0;
    });
    EXPECT_EQ(inner, 3U);
}

}  // namespace
}  // namespace vsplit::test
