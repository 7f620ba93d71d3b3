#include "make_assets/editable_mesh.h"

#include "make_assets/polygonise.h"
#include "make_assets/remesh.h"
#include "precompute/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace vsplit::assets {
namespace {

using precompute::check_manifold;

double ball(const Vector3& p)
{
    return length(p) - 1.0;
}

IndexedMesh make_ball(double cell)
{
    return polygonise(ball, {.low = {-1.2, -1.2, -1.2}, .high = {1.2, 1.2, 1.2}, .cell = cell});
}

IndexedMesh make_tetrahedron()
{
    return {
        .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

int euler(const IndexedMesh& mesh)
{
    return static_cast<int>(mesh.positions.size()) - static_cast<int>(mesh.triangles.size() / 2);
}

double volume(const IndexedMesh& mesh)
{
    double six_volumes = 0.0;
    for (const auto& [a, b, c] : mesh.triangles)
    {
        six_volumes +=
            dot(to_vector(mesh.positions[a]),
                cross(to_vector(mesh.positions[b]), to_vector(mesh.positions[c])));
    }
    return six_volumes / 6.0;
}

TEST(Polygonise, MakesAClosedOutwardSphere)
{
    const IndexedMesh mesh = make_ball(0.1);
    ASSERT_TRUE(check_manifold(mesh).has_value());
    EXPECT_EQ(euler(mesh), 2);
    EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi, 0.03);
}

TEST(EditableMesh, SplitsAnEdgeIntoFourFaces)
{
    EditableMesh mesh(make_tetrahedron());
    ASSERT_TRUE(mesh.split({0, 1}, {0.5, 0, 0}));
    const IndexedMesh result = mesh.compact();
    EXPECT_EQ(result.positions.size(), 5U);
    EXPECT_EQ(result.triangles.size(), 6U);
    EXPECT_TRUE(check_manifold(result).has_value());
    EXPECT_NEAR(volume(result), 1.0 / 6.0, 1e-12);
}

TEST(EditableMesh, RefusesWhatWouldBreakATetrahedron)
{
    EditableMesh mesh(make_tetrahedron());
    EXPECT_FALSE(mesh.collapse(0, 1, {0, 0, 0}));
    EXPECT_FALSE(mesh.flip({0, 1}));
    EXPECT_EQ(mesh.faces(2).size(), 3U);
}

TEST(EditableMesh, KeepsBoundaryVertices)
{
    const IndexedMesh square{
        .positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
        .triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
    EditableMesh mesh(square);
    EXPECT_TRUE(mesh.is_boundary(0));
    EXPECT_FALSE(mesh.is_boundary(4));
    EXPECT_FALSE(mesh.split({0, 1}, {0.5, 0, 0}));
    EXPECT_FALSE(mesh.collapse(4, 0, {0.5, 0.5, 0}));
}

TEST(EditableMesh, StaysManifoldUnderRandomEdits)
{
    EditableMesh mesh(make_ball(0.3));
    std::mt19937 random(11);
    int done = 0;
    for (int i = 0; i < 3000; ++i)
    {
        const auto edges = mesh.edges();
        const auto [a, b] = edges[random() % edges.size()];
        const Vector3 middle = (mesh.position(a) + mesh.position(b)) * 0.5;
        const bool changed = random() % 3 == 0   ? mesh.split({a, b}, middle)
                             : random() % 2 == 0 ? mesh.collapse(a, b, middle)
                                                 : mesh.flip({a, b});
        done += changed ? 1 : 0;
    }
    EXPECT_GT(done, 1000);
    const IndexedMesh result = mesh.compact();
    EXPECT_TRUE(check_manifold(result).has_value());
    EXPECT_EQ(euler(result), 2);
}

TEST(Remesh, KeepsTopologyAndLiesOnTheSurface)
{
    const IndexedMesh mesh = remesh(
        make_ball(0.1),
        surface_of(ball, 0.001),
        {.chord_error = 0.002, .shortest_edge = 0.02, .longest_edge = 0.5}
    );
    ASSERT_TRUE(check_manifold(mesh).has_value());
    EXPECT_EQ(euler(mesh), 2);
    const double wanted = std::sqrt(8.0 * 0.002 / std::sqrt(2.0));  // k1 = k2 = 1
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles)
    {
        sum += length(to_vector(mesh.positions[a]) - to_vector(mesh.positions[b]));
    }
    EXPECT_NEAR(sum / static_cast<double>(mesh.triangles.size()), wanted, 0.15 * wanted);
    for (const auto& position : mesh.positions)
    {
        ASSERT_NEAR(length(to_vector(position)), 1.0, 1e-5);
    }
}

}  // namespace
}  // namespace vsplit::assets
