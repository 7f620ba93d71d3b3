#include "precompute/vertex_neighbourhood.h"

#include "precompute/curvature_shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vsplit::precompute {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

IndexedMesh make_sheet(std::uint32_t cells)
{
    return test::sample_parametric(
        [](double u, double v) {
            return std::array{u, v, 0.0};
        },
        cells,
        cells
    );
}

TEST(NeighbourhoodSearch, FindsTheFirstNeighbour)
{
    const HalfEdgeMesh square = test::link(
        {.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
         .triangles = {{2, 3, 1}, {0, 1, 3}}}
    );
    EXPECT_EQ(first_neighbour(square, 0), 1U);
    EXPECT_EQ(first_neighbour(square, 1), 0U);
    EXPECT_EQ(first_neighbour(square, 2), 1U);
    EXPECT_EQ(first_neighbour(square, 3), 0U);
}

TEST(NeighbourhoodSearch, KeepsTheNearestOfATwoRingThatIsTooLarge)
{
    const IndexedMesh sheet = make_sheet(10);
    const HalfEdgeMesh linked = test::link(sheet);
    NeighbourhoodSearch search(linked);
    const std::uint32_t middle = 5 * 11 + 5;
    const std::size_t whole = search.two_ring(middle, 1000).size();
    EXPECT_GT(whole, 12U);
    EXPECT_THAT(
        search.two_ring(middle, 4), ElementsAre(4 * 11 + 5, 5 * 11 + 4, 5 * 11 + 6, 6 * 11 + 5)
    );
}

TEST(NeighbourhoodSearch, FindsSixteenToTwentyFiveNeighboursNearestFirst)
{
    const IndexedMesh sheet = make_sheet(12);
    const HalfEdgeMesh linked = test::link(sheet);
    NeighbourhoodSearch search(linked);
    for (std::uint32_t v = 0; v < sheet.positions.size(); ++v)
    {
        const auto neighbours = search.adaptive(v);
        ASSERT_GE(neighbours.size(), 16U);
        ASSERT_LE(neighbours.size(), 25U);
        double before = 0.0;
        for (const std::uint32_t w : neighbours)
        {
            ASSERT_NE(w, v);
            const double distance = std::hypot(
                sheet.positions[w][0] - sheet.positions[v][0],
                sheet.positions[w][1] - sheet.positions[v][1]
            );
            ASSERT_GE(distance, before - 1e-12);
            before = distance;
        }
    }
}

TEST(NeighbourhoodSearch, TakesMoreNeighboursWhereTheCentreIsDenser)
{
    // An evenly sampled sheet whose middle is pulled together by a smooth map.
    const auto count_for = [](double power) {
        const IndexedMesh sheet = test::sample_parametric(
            [power](double u, double v) {
                const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
                const double stretch = std::pow(std::max(1e-9, std::hypot(x, y)), power - 1.0);
                return std::array{x * stretch, y * stretch, 0.0};
            },
            40,
            40
        );
        const HalfEdgeMesh linked = test::link(sheet);
        return NeighbourhoodSearch(linked).adaptive(20 * 41 + 20).size();
    };
    EXPECT_EQ(count_for(6.0), 25U);
    EXPECT_EQ(count_for(1.0), 20U);
}

TEST(NeighbourhoodSearch, AdaptsToUnevenSampling)
{
    const IndexedMesh sheet = test::sample_parametric(
        [](double u, double v) {
            return std::array{u, v, 0.0};
        },
        40,
        40,
        {},
        0.45
    );
    const HalfEdgeMesh linked = test::link(sheet);
    NeighbourhoodSearch search(linked);
    std::array<int, 26> sizes{};
    for (std::uint32_t v = 0; v < sheet.positions.size(); ++v)
    {
        ++sizes[search.adaptive(v).size()];
    }
    for (std::size_t size = 17; size <= 22; ++size)
    {
        EXPECT_GT(sizes[size], 0) << size << " neighbours";
    }
}

TEST(NeighbourhoodSearch, StaysOnItsOwnSheet)
{
    // Two sheets a hair apart that share no vertex.
    IndexedMesh sheets = make_sheet(10);
    const auto count = static_cast<std::uint32_t>(sheets.positions.size());
    const std::size_t faces = sheets.triangles.size();
    for (std::uint32_t v = 0; v < count; ++v)
    {
        sheets.positions.push_back({sheets.positions[v][0], sheets.positions[v][1], 1e-6});
    }
    for (std::size_t f = 0; f < faces; ++f)
    {
        const auto [a, b, c] = sheets.triangles[f];
        sheets.triangles.push_back({a + count, b + count, c + count});
    }
    const HalfEdgeMesh linked = test::link(sheets);
    NeighbourhoodSearch search(linked);
    EXPECT_THAT(search.adaptive(60), testing::Each(testing::Lt(count)));
    EXPECT_THAT(search.adaptive(60 + count), testing::Each(testing::Ge(count)));
}

TEST(NeighbourhoodSearch, TakesPartOfAHugeRing)
{
    // A fan of 5000 triangles round vertex 0.
    constexpr std::uint32_t kSpokes = 5000;
    IndexedMesh fan{.positions = {{0, 0, 0}}, .triangles = {}};
    for (std::uint32_t i = 0; i < kSpokes; ++i)
    {
        const double angle = 2.0 * std::numbers::pi * i / kSpokes;
        fan.positions.push_back({std::cos(angle), std::sin(angle), 0.0});
        fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSpokes});
    }
    const HalfEdgeMesh linked = test::link(fan);
    EXPECT_EQ(linked.valence(vertex_handle(0)), kSpokes);
    NeighbourhoodSearch search(linked);
    for (const std::uint32_t v : {0U, 1U, 2500U, kSpokes})
    {
        const auto near = search.two_ring(v, 2 * kSpokes);
        EXPECT_GE(near.size(), 24U);
        EXPECT_LE(near.size(), 512U);
        EXPECT_THAT(near, testing::Not(testing::Contains(v)));
        EXPECT_GE(search.adaptive(v).size(), 16U);
    }
}

TEST(NeighbourhoodSearch, TakesAllThereIsOfASmallComponent)
{
    const IndexedMesh triangle{
        .positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, .triangles = {{0, 1, 2}}};
    const HalfEdgeMesh linked = test::link(triangle);
    NeighbourhoodSearch search(linked);
    EXPECT_THAT(search.adaptive(0), ElementsAre(1, 2));
    EXPECT_THAT(search.two_ring(2, 24), UnorderedElementsAre(0, 1));
}

}  // namespace
}  // namespace vsplit::precompute
