#include "precompute/wedges.h"

#include "codec/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace vsplit::test {
namespace {

using precompute::split_wedges;
using precompute::Wedges;
using ::testing::IsEmpty;

using Tables = std::vector<std::span<const Triangle>>;

/// By vertex its wedges.
std::vector<std::set<std::uint32_t>> by_vertex(const IndexedMesh& mesh, const Wedges& wedges)
{
    std::vector<std::set<std::uint32_t>> result(mesh.positions.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            result[mesh.triangles[f][k]].insert(wedges.corners[f][k]);
        }
    }
    return result;
}

TEST(SplitWedges, GivesEveryVertexOneWithoutValues)
{
    const IndexedMesh mesh = torus(8, 6, 0.0, 0);
    const Wedges wedges = split_wedges(mesh, {}, {});
    EXPECT_EQ(wedges.count, mesh.positions.size());
    for (const auto& list : by_vertex(mesh, wedges))
    {
        EXPECT_EQ(list.size(), 1U);
    }
}

TEST(SplitWedges, GivesEveryVertexOneWhereValuesAreThoseOfVertices)
{
    const IndexedMesh mesh = height_field(7, 6, 0.2, 1);
    const Wedges wedges = split_wedges(mesh, Tables{mesh.triangles}, {});
    EXPECT_EQ(wedges.count, mesh.positions.size());
}

TEST(SplitWedges, SplitsBetweenGroups)
{
    // Half of a disc is in another group: two seams meet in the hub, and two rim vertices have one.
    const IndexedMesh mesh = fan(6);
    const Wedges wedges = split_wedges(mesh, {}, std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1});
    EXPECT_EQ(wedges.count, 7U + 3U);
    EXPECT_EQ(by_vertex(mesh, wedges)[0].size(), 2U);
}

TEST(SplitWedges, SplitsAtACornerOfThreeGroups)
{
    const IndexedMesh mesh = fan(6);
    const Wedges wedges = split_wedges(mesh, {}, std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2});
    EXPECT_EQ(by_vertex(mesh, wedges)[0].size(), 3U);
    EXPECT_EQ(wedges.count, 7U + 2U + 3U);
}

TEST(SplitWedges, GivesTheEndOfASeamOneWedge)
{
    // The spoke from the hub to one rim vertex is a seam, because the rim has two values there.
    const IndexedMesh mesh = fan(6);
    std::vector<Triangle> table = mesh.triangles;
    const auto last = std::ranges::find_if(table, [](const Triangle& t) {
        return std::ranges::find(t, 3U) != t.end();
    });
    std::ranges::replace(*last, 3U, 100U);
    const Wedges wedges = split_wedges(mesh, Tables{table}, {});
    const auto lists = by_vertex(mesh, wedges);
    EXPECT_EQ(lists[0].size(), 1U);
    EXPECT_EQ(lists[3].size(), 2U);
    EXPECT_EQ(wedges.count, 8U);
}

TEST(SplitWedges, KeepsEqualValuesInDifferentSectorsApart)
{
    // Opposite quarters of the hub have the same value, but do not touch but in the hub.
    const IndexedMesh mesh = fan(8);
    std::vector<Triangle> table = mesh.triangles;
    for (std::size_t f = 0; f < table.size(); ++f)
    {
        std::ranges::replace(table[f], 0U, 100U + static_cast<std::uint32_t>(f / 2 % 2));
    }
    const Wedges wedges = split_wedges(mesh, Tables{table}, {});
    EXPECT_EQ(by_vertex(mesh, wedges)[0].size(), 4U);
    // Each of the four rim vertices between quarters has two.
    EXPECT_EQ(wedges.count, 8U + 4U + 4U);
}

TEST(SplitWedges, NumbersWithoutGaps)
{
    const IndexedMesh mesh = torus(9, 7, 0.0, 0);
    std::vector<std::uint32_t> groups(mesh.triangles.size());
    for (std::size_t f = 0; f < groups.size(); ++f)
    {
        groups[f] = static_cast<std::uint32_t>(f * 7 / 20 % 3);
    }
    const Wedges wedges = split_wedges(mesh, {}, groups);
    std::set<std::uint32_t> seen;
    for (const Triangle& t : wedges.corners)
    {
        seen.insert(t.begin(), t.end());
    }
    EXPECT_EQ(seen.size(), wedges.count);
    EXPECT_EQ(*seen.rbegin(), wedges.count - 1);
}

TEST(SplitWedges, TakesAnEmptyMesh)
{
    const Wedges wedges = split_wedges({}, {}, {});
    EXPECT_EQ(wedges.count, 0U);
    EXPECT_THAT(wedges.corners, IsEmpty());
}

}  // namespace
}  // namespace vsplit::test
