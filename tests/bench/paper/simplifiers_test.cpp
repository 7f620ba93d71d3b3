#include "paper/simplifiers.h"

#include "codec/shapes.h"
#include "paper/projection.h"
#include "paper/region_distance.h"
#include "precompute/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace vsplit::bench {
namespace {

using test::height_field;
using test::sphere;
using test::torus;

/// True when every vertex of a mesh is one of another's.
bool is_subset(const IndexedMesh& part, const IndexedMesh& whole)
{
    const std::set<std::array<double, 3>> known(whole.positions.begin(), whole.positions.end());
    return std::ranges::all_of(part.positions, [&](const auto& p) { return known.contains(p); });
}

IndexedMesh plane()
{
    IndexedMesh mesh = height_field(14, 14, 0.0, 1);
    for (auto& position : mesh.positions)
    {
        position[2] = 0.0;
    }
    return mesh;
}

double rms(const IndexedMesh& original, const IndexedMesh& shown)
{
    return region_distance(original, shown, 5000, {}).rms;
}

TEST(Simplifiers, OfManifoldsReachTheNumberOfFacesAndStayManifold)
{
    const IndexedMesh mesh = torus(16, 12, 0.02, 1);
    for (const std::size_t faces : {300U, 151U, 80U})
    {
        std::vector<IndexedMesh> results{
            simplify_by_energy(mesh, faces), simplify_by_open_mesh(mesh, faces)};
        for (const auto& [metric, name] : precompute::kMetricNames)
        {
            results.push_back(simplify_by_metric(mesh, metric, faces));
        }
        for (const IndexedMesh& result : results)
        {
            EXPECT_LE(result.triangles.size(), faces);
            EXPECT_GE(result.triangles.size() + 2, faces);
            const auto repaired = precompute::repair_mesh(result);
            ASSERT_TRUE(repaired.has_value());
            EXPECT_TRUE(repaired->report.clean());
            EXPECT_EQ(repaired->boundary_edges, 0U);
        }
    }
}

TEST(Simplifiers, OfOpenMeshesKeepThePlaneAndItsCorners)
{
    const IndexedMesh mesh = plane();
    for (const IndexedMesh& result :
         {simplify_by_energy(mesh, 60),
          simplify_by_metric(mesh, precompute::Metric::Curvature, 60),
          simplify_by_metric(mesh, precompute::Metric::Qem, 60)})
    {
        EXPECT_LE(result.triangles.size(), 60U);
        for (const auto& position : result.positions)
        {
            EXPECT_NEAR(position[2], 0.0, 1e-12);
        }
        EXPECT_LT(rms(mesh, result), 0.05 * std::hypot(13.0, 13.0));
    }
    EXPECT_NEAR(rms(mesh, simplify_by_metric(mesh, precompute::Metric::Qem, 60)), 0.0, 1e-3);
}

TEST(Simplifiers, OfHalfEdgesKeepVerticesWhereTheyAre)
{
    const IndexedMesh mesh = torus(20, 14, 0.02, 1);
    EXPECT_TRUE(is_subset(simplify_by_metric(mesh, precompute::Metric::Paper, 150), mesh));
    EXPECT_TRUE(is_subset(simplify_by_open_mesh(mesh, 150), mesh));
    EXPECT_FALSE(is_subset(simplify_by_energy(mesh, 150), mesh));
}

TEST(Simplifiers, ByEnergyComesCloserThanByEdgeLength)
{
    for (const IndexedMesh& mesh : {sphere(12, 16, 0.0, 1), torus(16, 10, 0.0, 1)})
    {
        const IndexedMesh shortest = simplify_by_metric(mesh, precompute::Metric::EdgeLength, 100);
        EXPECT_LT(rms(mesh, simplify_by_energy(mesh, 100)), 0.7 * rms(mesh, shortest));
    }
}

TEST(Clustering, LeavesAtMostTheFacesThatAreAskedFor)
{
    const IndexedMesh mesh = torus(40, 30, 0.02, 1);
    for (const Clustering clustering : {Clustering::Grid, Clustering::FloatingCell})
    {
        for (const std::size_t faces : {5000U, 2400U, 1000U, 300U, 50U})
        {
            const IndexedMesh result = simplify_by_clustering(mesh, clustering, faces);
            EXPECT_LE(result.triangles.size(), faces);
            EXPECT_GE(result.triangles.size(), std::min<std::size_t>(faces, 2400U) / 2);
            EXPECT_TRUE(is_subset(result, mesh));
        }
    }
}

TEST(Clustering, KeepsASpikeInAPlane)
{
    IndexedMesh mesh = plane();
    auto& spike = mesh.positions[14 * 6 + 6];
    spike[2] = 8.0;
    for (const Clustering clustering : {Clustering::Grid, Clustering::FloatingCell})
    {
        EXPECT_THAT(
            simplify_by_clustering(mesh, clustering, 40).positions, ::testing::Contains(spike)
        );
    }
}

TEST(Projection, FindsInnerPointsEdgesAndCorners)
{
    const std::array<Vector3, 3> corners{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const auto expect = [&](const Vector3& point, double square, auto... weights) {
        const Projection found = project(point, corners);
        EXPECT_NEAR(found.squared_distance, square, 1e-12);
        EXPECT_THAT(
            found.weights, ::testing::ElementsAre(::testing::DoubleNear(weights, 1e-12)...)
        );
    };
    expect({1, 1, 3}, 9.0, 0.5, 0.25, 0.25);
    expect({-2, -2, 1}, 9.0, 1.0, 0.0, 0.0);
    expect({9, -1, 0}, 26.0, 0.0, 1.0, 0.0);
    expect({1, -5, 0}, 25.0, 0.75, 0.25, 0.0);
    expect({3, 3, 0}, 2.0, 0.0, 0.5, 0.5);
}

TEST(Projection, BearsATriangleWithoutArea)
{
    const Projection found = project({1, 1, 0}, {{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}});
    EXPECT_NEAR(found.squared_distance, 1.0, 1e-12);
}

TEST(RegionDistance, MeasuresPlanesThatAreApart)
{
    const IndexedMesh mesh = plane();
    IndexedMesh higher = mesh;
    for (auto& position : higher.positions)
    {
        position[2] = 0.5;
    }
    const RegionDistance distance = region_distance(mesh, higher, 2000, {});
    EXPECT_NEAR(distance.rms, 0.5, 1e-5);
    EXPECT_NEAR(distance.max, 0.5, 1e-5);
    EXPECT_NEAR(distance.outside, 0.5, 1e-5);
    EXPECT_EQ(distance.inside, 0.0);
    EXPECT_NEAR(distance.normals, 0.0, 1e-3);
}

TEST(RegionDistance, TellsNormalsAndRegionsApart)
{
    // Two tilted halves meet in a ridge: 45 degrees off the plane everywhere.
    const IndexedMesh flat{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    IndexedMesh tilted = flat;
    tilted.positions[1][2] = tilted.positions[2][2] = 2.0;
    EXPECT_NEAR(region_distance(flat, tilted, 2000, {}).normals, 45.0, 0.1);

    const precompute::KeepSphere left{{0.0, 1.0, 0.0}, 1.0};
    const RegionDistance distance = region_distance(flat, tilted, 5000, left);
    EXPECT_GT(distance.inside, 0.0);
    EXPECT_LT(distance.inside, 0.6 * distance.outside);
    EXPECT_NEAR(distance.bounds, std::sqrt(8.0), 1e-6);
}

}  // namespace
}  // namespace vsplit::bench
