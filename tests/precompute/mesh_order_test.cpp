#include "precompute/mesh_order.h"

#include "codec/shapes.h"
#include "mesh/quantization_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace vsplit::test {
namespace {

using precompute::in_order;
using precompute::inverse_order;
using precompute::locality_order;

/// A mesh whose vertices and triangles come in no order at all.
IndexedMesh shuffled(const IndexedMesh& mesh)
{
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::mt19937 random(3);
    std::ranges::shuffle(order, random);
    IndexedMesh result = in_order(mesh, order);
    std::ranges::shuffle(result.triangles, random);
    return result;
}

TEST(MeshOrder, KeepsTheMesh)
{
    const IndexedMesh mesh = shuffled(torus(30, 20, 0.05, 1));
    const auto order = locality_order(mesh.positions);
    const IndexedMesh ordered = in_order(mesh, order);
    const QuantizationGrid grid = make_grid(mesh.positions, 16);
    EXPECT_EQ(face_set(quantize(grid, ordered)), face_set(quantize(grid, mesh)));
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        ASSERT_EQ(ordered.positions[i], mesh.positions[order[i]]);
        ASSERT_EQ(inverse_order(order)[order[i]], i);
    }
}

TEST(MeshOrder, BringsNeighboursTogether)
{
    const IndexedMesh mesh = shuffled(sphere(60, 80, 0.0, 1));
    const auto distance = [](const IndexedMesh& m) {
        double sum = 0.0;
        for (const auto& [a, b, c] : m.triangles)
        {
            sum += std::abs(static_cast<double>(a) - static_cast<double>(b));
        }
        return sum / static_cast<double>(m.triangles.size());
    };
    const IndexedMesh ordered = in_order(mesh, locality_order(mesh.positions));
    EXPECT_LT(distance(ordered), 0.15 * distance(mesh));
    for (std::size_t i = 1; i < ordered.triangles.size(); ++i)
    {
        ASSERT_LE(
            std::ranges::min(ordered.triangles[i - 1]), std::ranges::min(ordered.triangles[i])
        );
    }
}

TEST(MeshOrder, KeepsEqualAndUselessPointsInTheirOrder)
{
    const std::vector<std::array<double, 3>> points(5, {1.0, 2.0, 3.0});
    EXPECT_EQ(locality_order(points), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_TRUE(locality_order({}).empty());
}

TEST(MeshOrder, TakesValuesAlong)
{
    const std::vector<float> values{1.0F, 2.0F, 3.0F};
    const std::vector<std::uint32_t> order{2, 0, 1};
    EXPECT_EQ(in_order(std::span(values), order), (std::vector<float>{3.0F, 1.0F, 2.0F}));
    EXPECT_TRUE(in_order(std::span<const float>(), order).empty());
}

}  // namespace
}  // namespace vsplit::test
