#include "mesh/quantization_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace vsplit {
namespace {

using Point = std::array<double, 3>;
using Index = std::array<std::int32_t, 3>;

TEST(QuantizationGrid, SpansTheLargestExtent)
{
    const std::vector<Point> points{{1, 2, 3}, {5, 10, 4}};
    const auto grid = make_grid(points, 8);
    EXPECT_EQ(grid.origin, (Point{1, 2, 3}));
    // Rounded up to a binary32, so never too small and at most a few millionths of a percent off.
    EXPECT_GE(grid.cell, 8.0 / 255.0);
    EXPECT_LE(grid.cell, 8.0 / 255.0 * (1.0 + 1.2e-7));
    EXPECT_EQ(static_cast<double>(static_cast<float>(grid.cell)), grid.cell);
    EXPECT_EQ(quantize(grid, points[0]), (Index{0, 0, 0}));
    EXPECT_EQ(quantize(grid, points[1])[1], 255);
}

TEST(QuantizationGrid, GivesCoincidentPointsACellOfOne)
{
    const std::vector<Point> points{{7, 7, 7}, {7, 7, 7}};
    const auto grid = make_grid(points, 12);
    EXPECT_EQ(grid.cell, 1.0);
    EXPECT_EQ(dequantize(grid, quantize(grid, points[0])), points[0]);
}

TEST(QuantizationGrid, RoundsToTheNearestCell)
{
    const QuantizationGrid grid{.origin = {0, 0, 0}, .cell = 2.0, .bits = 8};
    EXPECT_EQ(quantize(grid, Point{0.99, 1.0, 3.1}), (Index{0, 1, 2}));
}

TEST(QuantizationGrid, ClampsPointsOutside)
{
    const QuantizationGrid grid{.origin = {0, 0, 0}, .cell = 1.0, .bits = 8};
    EXPECT_EQ(quantize(grid, Point{-5, 1e300, 255.4}), (Index{0, 255, 255}));
}

TEST(QuantizationGrid, MovesNoPointByMoreThanHalfACell)
{
    std::mt19937 random(1);
    std::vector<Point> points;
    for (int i = 0; i < 1000; ++i)
    {
        const auto coordinate = [&random] { return static_cast<double>(random()) / 1e6 - 2000.0; };
        points.push_back({coordinate(), coordinate(), coordinate()});
    }
    for (const int bits : {8, 12, 16, 20})
    {
        const auto grid = make_grid(points, bits);
        for (const auto& point : points)
        {
            const auto back = dequantize(grid, quantize(grid, point));
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                ASSERT_LE(std::abs(back[axis] - point[axis]), grid.cell * 0.5 * (1 + 1e-6));
            }
        }
    }
}

TEST(QuantizationGrid, KeepsGridPointsExactly)
{
    const QuantizationGrid grid{.origin = {-3.7, 11.1, 0.3}, .cell = 0.0123, .bits = 20};
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i)
    {
        const auto coordinate = [&random] {
            return static_cast<std::int32_t>(random() % (1U << 20));
        };
        const Index index{coordinate(), coordinate(), coordinate()};
        ASSERT_EQ(quantize(grid, dequantize(grid, index)), index);
    }
}

TEST(QuantizationGrid, PlacesCoarseIndicesAtTheCentreOfTheirCells)
{
    const QuantizationGrid grid{.origin = {10, 20, 30}, .cell = 1.0, .bits = 8};
    // Index 3 at shift 2 stands for the cells 12 .. 15; their centre is 13.5.
    EXPECT_EQ(dequantize(grid, Index{3, 0, 1}, 2), (Point{23.5, 21.5, 35.5}));
}

TEST(QuantizationGrid, CarriesTrianglesAlong)
{
    const IndexedMesh mesh{{{0, 0, 0}, {255, 0, 0}, {0, 255, 0}}, {{0, 1, 2}}};
    const auto grid = make_grid(mesh.positions, 8);
    const auto on_grid = quantize(grid, mesh);
    EXPECT_EQ(on_grid.triangles, mesh.triangles);
    EXPECT_EQ(on_grid.positions[2], (Index{0, 255, 0}));
    EXPECT_EQ(dequantize(grid, on_grid).positions, mesh.positions);
}

}  // namespace
}  // namespace vsplit
