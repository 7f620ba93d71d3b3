#include "mesh/closest_point_tree.h"

#include "mesh/test_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace vsplit {
namespace {

using Point = std::array<float, 3>;
using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector along(const Vector& a, double t, const Vector& d)
{
    return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}

Vector minus(const Vector& a, const Vector& b)
{
    return along(a, -1.0, b);
}

double squared_to_segment(const Vector& p, const Vector& a, const Vector& b)
{
    const Vector ab = minus(b, a);
    const double length = dot(ab, ab);
    const double t = length > 0.0 ? std::clamp(dot(minus(p, a), ab) / length, 0.0, 1.0) : 0.0;
    const Vector rest = minus(p, along(a, t, ab));
    return dot(rest, rest);
}

/// The distance by another route than the tree takes: the plane's foot point when three cross products
/// agree in sign, else the nearest edge; in double precision.
double squared_to_triangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c)
{
    const auto cross = [](const Vector& u, const Vector& v) {
        return Vector{
            u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    const Vector normal = cross(minus(b, a), minus(c, a));
    const double area = dot(normal, normal);
    const bool inside = area > 0.0 && dot(cross(minus(b, a), minus(p, a)), normal) >= 0.0 &&
                        dot(cross(minus(c, b), minus(p, b)), normal) >= 0.0 &&
                        dot(cross(minus(a, c), minus(p, c)), normal) >= 0.0;
    if (inside)
    {
        const double height = dot(minus(p, a), normal);
        return height * height / area;
    }
    return std::min(
        {squared_to_segment(p, a, b), squared_to_segment(p, b, c), squared_to_segment(p, c, a)}
    );
}

Vector wide(const Point& p)
{
    return {p[0], p[1], p[2]};
}

double brute_force(const test::Surface& surface, const Point& point)
{
    double best = std::numeric_limits<double>::infinity();
    for (const Triangle& t : surface.triangles)
    {
        best = std::min(
            best,
            squared_to_triangle(
                wide(point),
                wide(surface.positions[t[0]]),
                wide(surface.positions[t[1]]),
                wide(surface.positions[t[2]])
            )
        );
    }
    return best;
}

float distance_to(const test::Surface& surface, const Point& point)
{
    const ClosestPointTree tree(surface.positions, surface.triangles);
    std::uint32_t hint = 0;
    return std::sqrt(tree.squared_distance(point, hint));
}

test::Surface random_soup(std::uint32_t seed, std::size_t triangles)
{
    std::mt19937 random(seed);
    const auto coordinate = [&random] { return static_cast<float>(random() % 10000) / 1000.0F; };
    test::Surface surface;
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
    {
        surface.positions.push_back({coordinate(), coordinate(), coordinate()});
    }
    for (std::uint32_t i = 0; i < triangles; ++i)
    {
        surface.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return surface;
}

// The seven regions of the plane about the triangle (0,0,0), (4,0,0), (0,4,0), each at height 3.
TEST(ClosestPointTree, HandlesEveryRegionOfATriangle)
{
    const test::Surface surface{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
    EXPECT_FLOAT_EQ(distance_to(surface, {1, 1, 3}), 3.0F);                // inside
    EXPECT_FLOAT_EQ(distance_to(surface, {2, -4, 3}), 5.0F);               // edge AB
    EXPECT_FLOAT_EQ(distance_to(surface, {-4, 2, 3}), 5.0F);               // edge AC
    EXPECT_FLOAT_EQ(distance_to(surface, {4, 4, 3}), std::sqrt(17.0F));    // edge BC
    EXPECT_FLOAT_EQ(distance_to(surface, {-4, -4, 3}), std::sqrt(41.0F));  // corner A
    EXPECT_FLOAT_EQ(distance_to(surface, {8, -3, 3}), std::sqrt(34.0F));   // corner B
    EXPECT_FLOAT_EQ(distance_to(surface, {-3, 8, 3}), std::sqrt(34.0F));   // corner C
}

TEST(ClosestPointTree, IsZeroOnTheSurface)
{
    const test::Surface surface{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(distance_to(surface, {0, 0, 0}), 0.0F);
    EXPECT_EQ(distance_to(surface, {2, 0, 0}), 0.0F);
    EXPECT_EQ(distance_to(surface, {1, 2, 0}), 0.0F);
}

TEST(ClosestPointTree, AgreesWithBruteForceOnRandomTriangles)
{
    for (const std::size_t triangles : {1U, 3U, 4U, 5U, 16U, 17U, 200U, 1001U})
    {
        const auto surface = random_soup(static_cast<std::uint32_t>(triangles), triangles);
        const ClosestPointTree tree(surface.positions, surface.triangles);
        std::mt19937 random(7);
        std::uint32_t hint = 0;
        for (int i = 0; i < 200; ++i)
        {
            const auto coordinate = [&random] {
                return static_cast<float>(random() % 16000) / 1000.0F - 3.0F;
            };
            const Point point{coordinate(), coordinate(), coordinate()};
            const double expected = std::sqrt(brute_force(surface, point));
            const double actual = std::sqrt(tree.squared_distance(point, hint));
            ASSERT_NEAR(actual, expected, 1e-4) << triangles << " triangles, query " << i;
        }
    }
}

TEST(ClosestPointTree, GivesTheClosestTriangleAsHint)
{
    const auto surface = random_soup(3, 300);
    const ClosestPointTree tree(surface.positions, surface.triangles);
    for (std::uint32_t i = 0; i < surface.triangles.size(); ++i)
    {
        const Point corner = surface.positions[surface.triangles[i][0]];
        std::uint32_t hint = 0;
        ASSERT_EQ(tree.squared_distance(corner, hint), 0.0F);
        const Triangle found = surface.triangles[hint];
        ASSERT_NEAR(
            squared_to_triangle(
                wide(corner),
                wide(surface.positions[found[0]]),
                wide(surface.positions[found[1]]),
                wide(surface.positions[found[2]])
            ),
            0.0,
            1e-9
        );
    }
}

TEST(ClosestPointTree, DoesNotDependOnTheHint)
{
    const auto surface = test::make_sphere(1.0, 24);
    const ClosestPointTree tree(surface.positions, surface.triangles);
    const Point point{0.3F, -0.7F, 0.9F};
    std::uint32_t first = 0;
    const float expected = tree.squared_distance(point, first);
    for (std::uint32_t hint = 0; hint < surface.triangles.size(); hint += 37)
    {
        std::uint32_t other = hint;
        EXPECT_EQ(tree.squared_distance(point, other), expected) << hint;
    }
    std::uint32_t senseless = 0xFFFF'FFFFU;
    EXPECT_EQ(tree.squared_distance(point, senseless), expected);
}

TEST(ClosestPointTree, TakesDegenerateTrianglesAsSegmentsAndPoints)
{
    const test::Surface segment{{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}};
    EXPECT_FLOAT_EQ(distance_to(segment, {1.5F, 2, 0}), 2.0F);
    EXPECT_FLOAT_EQ(distance_to(segment, {5, 4, 0}), 5.0F);
    const test::Surface dot{{{1, 1, 1}}, {{0, 0, 0}}};
    EXPECT_FLOAT_EQ(distance_to(dot, {1, 4, 5}), 5.0F);
    const test::Surface repeated{{{0, 0, 0}, {2, 0, 0}}, {{0, 1, 1}, {0, 0, 1}}};
    EXPECT_FLOAT_EQ(distance_to(repeated, {1, 3, 0}), 3.0F);
}

TEST(ClosestPointTree, WorksInAnyUnit)
{
    for (const float unit : {1e-12F, 1e-6F, 1.0F, 1e6F, 1e12F})
    {
        const test::Surface surface{{{0, 0, 0}, {4 * unit, 0, 0}, {0, 4 * unit, 0}}, {{0, 1, 2}}};
        EXPECT_NEAR(distance_to(surface, {unit, unit, 3 * unit}) / unit, 3.0F, 1e-5F) << unit;
        EXPECT_NEAR(distance_to(surface, {2 * unit, -4 * unit, 3 * unit}) / unit, 5.0F, 1e-5F)
            << unit;
    }
}

}  // namespace
}  // namespace vsplit
