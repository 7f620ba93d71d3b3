#include "precompute/surface_fit.h"

#include "codec/shapes.h"
#include "precompute/level_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace vsplit::test {
namespace {

using precompute::FitSource;
using precompute::PlacedLevels;
using precompute::PlacementSource;
using precompute::QuadraticForm;
using precompute::SurfaceFit;
using precompute::Vector3;
using precompute::operator+;
using precompute::operator-;
using precompute::operator*;
using precompute::dot;

constexpr double kRadius = 800.0;
constexpr double kMiddle = 1000.0;

/// A sphere in grid units.
IndexedMesh ball(std::uint32_t rows, std::uint32_t columns)
{
    IndexedMesh mesh = sphere(rows, columns, 0.0, 1);
    for (auto& p : mesh.positions)
    {
        const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (double& coordinate : p)
        {
            coordinate = coordinate / length * kRadius + kMiddle;
        }
    }
    return mesh;
}

double height(const Vector3& p)
{
    const Vector3 off = p - Vector3{kMiddle, kMiddle, kMiddle};
    return std::sqrt(dot(off, off)) - kRadius;
}

/// A fine ball and what fits are made from.
struct FineBall
{
    FineBall() : mesh(ball(60, 120)), positions(to_floats(mesh)), tree(positions, mesh.triangles) {}

    static std::vector<std::array<float, 3>> to_floats(const IndexedMesh& mesh)
    {
        std::vector<std::array<float, 3>> result;
        for (const auto& [x, y, z] : mesh.positions)
        {
            result.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        }
        return result;
    }

    [[nodiscard]] FitSource fit_source() const
    {
        return {positions, mesh.triangles, sample_surface(positions, mesh.triangles, 4000), &tree};
    }

    IndexedMesh mesh;
    std::vector<std::array<float, 3>> positions;
    ClosestPointTree tree;
};

TEST(QuadraticForm, IsLeastWhereItIsAttractedTo)
{
    QuadraticForm form;
    form.matrix = {3.0, 0.5, -0.25, 2.0, 0.125, 1.0};
    form.linear = {1.0, -2.0, 0.5};
    form.attract({4.0, 5.0, 6.0}, 0.75);
    const Vector3 least = form.minimum();
    const double value = form.evaluate(least);
    for (const Vector3 off : {Vector3{0.1, 0.0, 0.0}, {0.0, -0.1, 0.0}, {0.0, 0.0, 0.1}, {1, 1, 1}})
    {
        EXPECT_GT(form.evaluate(least + off), value);
        EXPECT_GT(form.evaluate(least - off), value);
    }
}

TEST(QuadraticForm, HasNoMinimumWithoutSamples)
{
    EXPECT_EQ(QuadraticForm{}.minimum(), Vector3{});
}

TEST(SurfaceFit, LiftsTheVerticesOfACoarseBall)
{
    const FineBall fine;
    const IndexedMesh coarse = ball(8, 12);
    SurfaceFit fit(fine.fit_source(), coarse.positions, coarse.triangles, 1);
    double lift = 0.0;
    for (std::uint32_t v = 0; v < coarse.positions.size(); ++v)
    {
        QuadraticForm form = fit.form(v);
        form.attract({}, 0.05 * form.weight);
        const Vector3 step = form.minimum();
        EXPECT_LT(form.evaluate(step), 0.0);
        fit.move(v, step);
        lift += height(fit.place(v));
    }
    // Faces of an inscribed ball lie inside by a third of their sagitta on average.
    EXPECT_GT(lift / static_cast<double>(coarse.positions.size()), 5.0);
}

TEST(SurfaceFit, MovesChangeTheFormAsTheFormSaid)
{
    const FineBall fine;
    const IndexedMesh coarse = ball(6, 9);
    SurfaceFit fit(fine.fit_source(), coarse.positions, coarse.triangles, 1);
    const QuadraticForm before = fit.form(4);
    const Vector3 step{3.0, -2.0, 5.0};
    fit.move(4, step);
    const QuadraticForm after = fit.form(4);
    const Vector3 back = step * -1.0;
    EXPECT_NEAR(
        after.evaluate(back), -before.evaluate(step), 1e-2 * std::fabs(before.evaluate(step))
    );
}

TEST(SurfaceFit, IsTheSameForAnyNumberOfThreads)
{
    const FineBall fine;
    const IndexedMesh coarse = ball(20, 40);
    const SurfaceFit one(fine.fit_source(), coarse.positions, coarse.triangles, 1);
    const SurfaceFit three(fine.fit_source(), coarse.positions, coarse.triangles, 3);
    for (std::uint32_t v = 0; v < coarse.positions.size(); ++v)
    {
        EXPECT_EQ(one.form(v).matrix, three.form(v).matrix);
        EXPECT_EQ(one.form(v).linear, three.form(v).linear);
    }
}

/// Every vertex of the fine ball that a coarse one is made of, and the coarse faces: the ball's rows and
/// columns that a step divides.
struct Coarsened
{
    static constexpr int kBits = 11;

    Coarsened() : grid{.positions = {}, .triangles = fine.mesh.triangles}
    {
        for (const Vector3& p : fine.mesh.positions)
        {
            grid.positions.push_back(quantize({.origin = {}, .cell = 1.0, .bits = kBits}, p));
        }
    }

    [[nodiscard]] PlacementSource source(std::span<const std::uint8_t> locked = {}) const
    {
        return {fine.mesh.positions, &grid, &fine.tree, locked, kBits};
    }

    /// The coarse ball's faces between the nearest vertices of the fine one.
    [[nodiscard]] PlacedLevels level(std::uint32_t rows, std::uint32_t columns, int shift) const
    {
        const IndexedMesh coarse = ball(rows, columns);
        PlacedLevels level;
        level.shift = shift;
        level.finest = coarse.triangles;
        for (Triangle& triangle : level.finest)
        {
            for (std::uint32_t& v : triangle)
            {
                v = nearest(coarse.positions[v]);
            }
        }
        return level;
    }

    [[nodiscard]] std::uint32_t nearest(const Vector3& point) const
    {
        const auto square = [&](const Vector3& p) { return dot(p - point, p - point); };
        return static_cast<std::uint32_t>(
            std::ranges::min_element(fine.mesh.positions, {}, square) - fine.mesh.positions.begin()
        );
    }

    FineBall fine;
    GridMesh grid;
};

TEST(LevelPlacement, ShowsConvexVerticesFurtherOut)
{
    const Coarsened ball;
    const auto placed = place_levels(ball.source(), std::vector{ball.level(8, 12, 4)}, 1);
    ASSERT_EQ(placed.size(), 1U);
    ASSERT_GT(placed.front().size(), 20U);
    double gained = 0.0;
    for (const auto& [vertex, cell] : placed.front())
    {
        const QuantizationGrid unit{.origin = {}, .cell = 1.0, .bits = Coarsened::kBits};
        auto own = ball.grid.positions[vertex];
        for (std::int32_t& coordinate : own)
        {
            coordinate >>= 4;
        }
        EXPECT_NE(cell, own);
        gained += height(dequantize(unit, cell, 4)) - height(dequantize(unit, own, 4));
    }
    EXPECT_GT(gained / static_cast<double>(placed.front().size()), 5.0);
}

TEST(LevelPlacement, LeavesLockedVerticesAlone)
{
    const Coarsened ball;
    const std::vector<std::uint8_t> locked(ball.grid.positions.size(), 1);
    const auto placed = place_levels(ball.source(locked), std::vector{ball.level(8, 12, 4)}, 1);
    EXPECT_TRUE(placed.front().empty());
}

TEST(LevelPlacement, SuitsTheCoarsestLevelAndTheFinest)
{
    const Coarsened ball;
    const PlacedLevels coarse = ball.level(6, 8, 2);
    PlacedLevels both = ball.level(24, 32, 2);
    const auto lift = [&](const PlacedLevels& levels) {
        const auto placed = place_levels(ball.source(), std::vector{levels}, 1);
        const QuantizationGrid unit{.origin = {}, .cell = 1.0, .bits = Coarsened::kBits};
        double sum = 0.0;
        for (const auto& [vertex, cell] : placed.front())
        {
            const bool is_coarse = std::ranges::any_of(coarse.finest, [v = vertex](const auto& t) {
                return std::ranges::find(t, v) != t.end();
            });
            sum += is_coarse ? height(dequantize(unit, cell, 2)) : 0.0;
        }
        return sum;
    };
    const double of_finest = lift(both);
    both.coarsest = coarse.finest;
    const double of_both = lift(both);
    // The larger its faces the further out a ball's vertices are best.
    EXPECT_GT(of_both, of_finest);
    EXPECT_LT(of_both, lift(coarse));
}

using Cell = std::array<std::int32_t, 3>;

TEST(LevelPlacement, DoesNotHoldNewVerticesBack)
{
    const Coarsened ball;
    std::vector levels{ball.level(12, 16, 5), ball.level(12, 16, 4)};
    const auto known = place_levels(ball.source(), levels, 1);
    for (const Triangle& triangle : levels.back().finest)
    {
        levels.back().born.insert(levels.back().born.end(), triangle.begin(), triangle.end());
    }
    const auto born = place_levels(ball.source(), levels, 1);
    // How far vertices are from where the coarser grid showed them.
    const auto distance = [&](const auto& placed) {
        std::map<std::uint32_t, Cell> before;
        for (const auto& [vertex, cell] : placed.front())
        {
            before[vertex] = cell;
        }
        std::int64_t sum = 0;
        for (const auto& [vertex, cell] : placed.back())
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const std::int32_t shown = before.contains(vertex)
                                               ? before[vertex][axis]
                                               : ball.grid.positions[vertex][axis] >> 5;
                sum += std::abs(2 * cell[axis] - 4 * shown - 1);
            }
        }
        return sum;
    };
    EXPECT_GT(distance(born), distance(known));
}

TEST(LevelPlacement, IsTheSameForAnyNumberOfThreads)
{
    const Coarsened ball;
    const std::vector levels{ball.level(8, 12, 5), ball.level(16, 24, 4)};
    const auto one = place_levels(ball.source(), levels, 1);
    const auto three = place_levels(ball.source(), levels, 3);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i)
    {
        ASSERT_EQ(one[i].size(), three[i].size());
        for (std::size_t k = 0; k < one[i].size(); ++k)
        {
            EXPECT_EQ(one[i][k].vertex, three[i][k].vertex);
            EXPECT_EQ(one[i][k].position, three[i][k].position);
        }
    }
}

TEST(LevelPlacement, IsNotForManyVerticesOrFineGrids)
{
    EXPECT_TRUE(precompute::is_worth_placing(100, 1000, 3));
    EXPECT_FALSE(precompute::is_worth_placing(500, 1000, 3));
    EXPECT_FALSE(precompute::is_worth_placing(100, 1000, 0));
}

}  // namespace
}  // namespace vsplit::test
