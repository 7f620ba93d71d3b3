#include "precompute/fan_distance.h"

#include "codec/shapes.h"
#include "mesh/closest_point_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace vsplit::test {
namespace {

using precompute::closest_shares;
using precompute::CollapseMesh;
using precompute::FaceFan;
using Point = std::array<float, 3>;

/// A shape with what the distances need of it.
struct Walkable
{
    explicit Walkable(const IndexedMesh& shape)
        : mesh(static_cast<std::uint32_t>(shape.positions.size()), shape.triangles),
          triangles(shape.triangles)
    {
        for (const auto& [x, y, z] : shape.positions)
        {
            positions.push_back(
                {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}
            );
        }
    }

    [[nodiscard]] FaceFan::Closest in_fan(std::uint32_t vertex, const Point& point) const
    {
        FaceFan fan;
        fan.collect(mesh, vertex, [this](std::uint32_t v) { return positions[v]; });
        return fan.closest(mesh, point);
    }

    CollapseMesh mesh;
    std::vector<Triangle> triangles;
    std::vector<Point> positions;
};

std::vector<Point> random_points(std::size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> coordinate(-1.5F, 1.5F);
    std::vector<Point> points(count);
    for (Point& point : points)
    {
        point = {coordinate(random), coordinate(random), coordinate(random)};
    }
    return points;
}

float square_of(const Point& a, const Point& b)
{
    float sum = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    }
    return sum;
}

TEST(FaceFan, FindsTheClosestOfItsFaces)
{
    const Walkable shape(sphere(7, 9, 0.2, 1));
    for (const Point& point : random_points(200, 2))
    {
        for (const std::uint32_t vertex : {0U, 1U, 12U, 30U})
        {
            std::vector<Triangle> faces;
            for (const Triangle& triangle : shape.triangles)
            {
                if (std::ranges::find(triangle, vertex) != triangle.end())
                {
                    faces.push_back(triangle);
                }
            }
            std::uint32_t face = 0;
            const float wanted =
                ClosestPointTree(shape.positions, faces).squared_distance(point, face);
            const FaceFan::Closest found = shape.in_fan(vertex, point);
            ASSERT_NEAR(found.square, wanted, 1e-5F);
            ASSERT_TRUE(shape.mesh.has_face(found.face));
            ASSERT_NE(
                std::ranges::find(shape.triangles[found.face], vertex),
                shape.triangles[found.face].end()
            );
        }
    }
}

TEST(FaceFan, EndsAtTheBoundary)
{
    const Walkable shape(fan(5));
    const Point outside{3.0F, 0.5F, 0.0F};
    std::uint32_t face = 0;
    const ClosestPointTree tree(shape.positions, shape.triangles);
    EXPECT_NEAR(shape.in_fan(0, outside).square, tree.squared_distance(outside, face), 1e-5F);
}

TEST(FaceFan, NeverLeadsToAHub)
{
    const Walkable shape(double_cone(200));
    for (std::uint32_t vertex = 0; vertex < shape.positions.size(); ++vertex)
    {
        if (shape.mesh.valence(vertex) > FaceFan::kMostFaces)
        {
            const FaceFan::Closest found = shape.in_fan(vertex, shape.positions[vertex]);
            EXPECT_EQ(found.square, 0.0F);
            EXPECT_LE(shape.mesh.valence(found.corner), FaceFan::kMostFaces);
        }
    }
}

TEST(WalkToClosest, FindsTheClosestPointOfAConvexSurfaceFromAnywhere)
{
    const Walkable shape(sphere(12, 16, 0.0, 1));
    const ClosestPointTree tree(shape.positions, shape.triangles);
    const auto position_of = [&](std::uint32_t v) { return shape.positions[v]; };
    for (const Point& point : random_points(300, 3))
    {
        if (square_of(point, {}) < 1.0F)
        {
            continue;  // inside, where there are other local minima
        }
        std::uint32_t face = 0;
        const float wanted = tree.squared_distance(point, face);
        const auto found = precompute::walk_to_closest(shape.mesh, point, 17, position_of);
        ASSERT_NEAR(found.square, wanted, 1e-4F);
    }
}

TEST(WalkToClosest, NeverPromisesTooMuch)
{
    const Walkable shape(torus(30, 14, 0.2, 5));
    const ClosestPointTree tree(shape.positions, shape.triangles);
    const auto position_of = [&](std::uint32_t v) { return shape.positions[v]; };
    for (const Point& point : random_points(300, 6))
    {
        std::uint32_t face = 0;
        const float least = tree.squared_distance(point, face);
        for (const std::uint32_t start : {0U, 100U, 250U})
        {
            const auto found = precompute::walk_to_closest(shape.mesh, point, start, position_of);
            ASSERT_GE(found.square, least - 1e-5F);
        }
    }
}

TEST(ClosestShares, AreThoseOfTheClosestPoint)
{
    const Point a{0.0F, 0.0F, 0.0F};
    const Point b{1.0F, 0.0F, 0.2F};
    const Point c{0.3F, 0.8F, 0.0F};
    const ClosestPointTree tree(std::vector<Point>{a, b, c}, std::vector<Triangle>{{0, 1, 2}});
    for (const Point& point : random_points(500, 7))
    {
        const auto [wa, wb, wc] = closest_shares(point, a, b, c);
        ASSERT_GE(std::min({wa, wb, wc}), 0.0F);
        ASSERT_NEAR(wa + wb + wc, 1.0F, 1e-5F);
        Point closest{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            closest[axis] = wa * a[axis] + wb * b[axis] + wc * c[axis];
        }
        std::uint32_t face = 0;
        ASSERT_NEAR(square_of(closest, point), tree.squared_distance(point, face), 1e-5F);
    }
}

}  // namespace
}  // namespace vsplit::test
