#include "mesh/surface_distance.h"

#include "mesh/test_meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

namespace vsplit {
namespace {

SurfaceDistance distance_between(
    const test::Surface& a, const test::Surface& b, std::size_t samples = 4000
)
{
    return DistanceReference(a.positions, a.triangles, samples).measure(b.positions, b.triangles);
}

TEST(SampleSurface, PutsEveryPointOnTheSurface)
{
    const auto plane = test::make_plane(2.0F, 0.5F, 3);
    for (const auto& [point, triangle] : sample_surface(plane.positions, plane.triangles, 1000))
    {
        ASSERT_LT(triangle, plane.triangles.size());
        ASSERT_FLOAT_EQ(point[2], 0.5F);
        ASSERT_GE(std::min(point[0], point[1]), -1e-6F);
        ASSERT_LE(std::max(point[0], point[1]), 2.0F + 1e-6F);
    }
}

TEST(SampleSurface, GivesEachTriangleItsShareOfTheArea)
{
    // Areas 0.5 and 4.5; every stratum holds one sample, so that the shares are exact to one sample.
    const test::Surface surface{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}, {3, 0, 9}, {0, 3, 9}}, {{0, 1, 2}, {3, 4, 5}}};
    int upper = 0;
    for (const auto& [point, triangle] : sample_surface(surface.positions, surface.triangles, 1000))
    {
        upper += point[2] > 4.5F ? 1 : 0;
        ASSERT_EQ(triangle, point[2] > 4.5F ? 1U : 0U);
    }
    EXPECT_NEAR(upper, 900, 1);
}

TEST(SampleSurface, SkipsDegenerateTriangles)
{
    const test::Surface surface{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {50, 0, 0}}, {{3, 3, 3}, {0, 1, 2}, {0, 1, 3}}};
    for (const auto& [point, triangle] : sample_surface(surface.positions, surface.triangles, 100))
    {
        ASSERT_LE(point[0], 1.0F);
        ASSERT_EQ(triangle, 1U);
    }
}

TEST(SampleSurface, IsTheSameEveryTimeAndOnEveryMachine)
{
    const auto sphere = test::make_sphere(1.0, 8);
    const auto first = sample_surface(sphere.positions, sphere.triangles, 500);
    EXPECT_EQ(first, sample_surface(sphere.positions, sphere.triangles, 500));

    const test::Surface triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const auto pinned = sample_surface(triangle.positions, triangle.triangles, 1);
    EXPECT_EQ(pinned, (std::vector<SurfaceSample>{{{0x1.980766p-2F, 0x1.bb3202p-5F, 0.0F}, 0}}));
}

TEST(SurfaceDistance, OfParallelPlanesIsTheirGap)
{
    const auto distance =
        distance_between(test::make_plane(1.0F, 0.0F, 8), test::make_plane(1.0F, 0.25F, 3));
    EXPECT_NEAR(distance.rms, 0.25, 1e-6);
    EXPECT_NEAR(distance.max, 0.25, 1e-6);
}

TEST(SurfaceDistance, OfConcentricSpheresIsTheDifferenceOfRadii)
{
    const auto distance =
        distance_between(test::make_sphere(1.0, 100), test::make_sphere(1.1, 100));
    EXPECT_NEAR(distance.rms, 0.1, 5e-4);
    EXPECT_NEAR(distance.max, 0.1, 5e-4);
}

TEST(SurfaceDistance, OfASurfaceToItselfIsZero)
{
    const auto sphere = test::make_sphere(5.0, 40);
    const auto distance = distance_between(sphere, sphere);
    EXPECT_LT(distance.max, 1e-5);  // single precision, radius 5
}

TEST(SurfaceDistance, TakesTheLargerOfBothDirections)
{
    // Half of the large plane has no counterpart: seen from it the mean square is
    // (1/2) * integral of x^2 over 0 .. 1 = 1/6; seen from the small one it is 0.
    const test::Surface large{
        {{-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const test::Surface small{
        {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto forth = distance_between(large, small, 40'000);
    const auto back = distance_between(small, large, 40'000);
    EXPECT_NEAR(forth.rms, std::sqrt(1.0 / 6.0), 5e-3);
    EXPECT_EQ(back.rms, forth.rms);
    EXPECT_NEAR(back.max, 1.0, 0.01);
}

TEST(SurfaceDistance, BearsDegenerateTriangles)
{
    auto plane = test::make_plane(1.0F, 0.0F, 4);
    plane.triangles.push_back({0, 0, 0});
    plane.triangles.push_back({0, 1, 2});
    const auto distance = distance_between(plane, test::make_plane(1.0F, 0.5F, 4));
    EXPECT_NEAR(distance.rms, 0.5, 1e-6);
}

TEST(SurfaceDistance, IsTheSameFromSeveralThreads)
{
    const auto sphere = test::make_sphere(1.0, 30);
    const auto other = test::make_sphere(1.01, 17);
    const DistanceReference reference(sphere.positions, sphere.triangles, 2000);
    const auto expected = reference.measure(other.positions, other.triangles);
    std::vector<SurfaceDistance> results(4);
    std::vector<std::jthread> threads;
    for (auto& result : results)
    {
        threads.emplace_back([&] { result = reference.measure(other.positions, other.triangles); });
    }
    threads.clear();
    for (const auto& result : results)
    {
        EXPECT_EQ(result.rms, expected.rms);
        EXPECT_EQ(result.max, expected.max);
    }
}

}  // namespace
}  // namespace vsplit
