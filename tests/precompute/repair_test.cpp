#include "precompute/repair.h"

#include "precompute/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

namespace vsplit::test {
namespace {

using precompute::check_manifold;
using precompute::repair_mesh;
using precompute::RepairedMesh;
using precompute::RepairReport;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Point = std::array<double, 3>;

/// A tetrahedron, outwards.
IndexedMesh tetrahedron()
{
    return {
        {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Distinct points for meshes whose shape does not matter.
std::vector<Point> points(std::size_t count)
{
    std::vector<Point> result;
    for (std::size_t i = 0; i < count; ++i)
    {
        const auto x = static_cast<double>(i);
        result.push_back({x, x * x, 1.0});
    }
    return result;
}

/// A strip of `count` squares whose ends are joined, turned over when `twisted`.
IndexedMesh ring(std::uint32_t count, bool twisted)
{
    IndexedMesh mesh{points(2 * std::size_t{count}), {}};
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const bool last = i + 1 == count;
        const std::uint32_t a = 2 * i;
        const std::uint32_t b = a + 1;
        const std::uint32_t c = last ? (twisted ? 1U : 0U) : a + 2;
        const std::uint32_t d = last ? (twisted ? 0U : 1U) : a + 3;
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({c, b, d});
    }
    return mesh;
}

/// A grid of squares whose sides are glued: a torus, or a Klein bottle when `twisted`.
IndexedMesh closed_grid(std::uint32_t size, bool twisted)
{
    IndexedMesh mesh{points(std::size_t{size} * size), {}};
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        const bool wraps = y >= size;
        const std::uint32_t column = wraps && twisted ? size - (x % size) : x;
        return (y % size) * size + column % size;
    };
    for (std::uint32_t y = 0; y < size; ++y)
    {
        for (std::uint32_t x = 0; x < size; ++x)
        {
            mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
            mesh.triangles.push_back({at(x, y + 1), at(x + 1, y), at(x + 1, y + 1)});
        }
    }
    return mesh;
}

RepairedMesh repaired(const IndexedMesh& mesh)
{
    auto result = repair_mesh(mesh);
    EXPECT_TRUE(result) << result.error().message;
    const auto valid = check_manifold(result->mesh);
    EXPECT_TRUE(valid) << valid.error().message;
    return std::move(*result);
}

TEST(Repair, TakesACleanMeshOverUnchanged)
{
    const IndexedMesh mesh = tetrahedron();
    const RepairedMesh result = repaired(mesh);
    EXPECT_TRUE(result.report.clean());
    EXPECT_EQ(result.mesh.positions, mesh.positions);
    EXPECT_EQ(result.mesh.triangles, mesh.triangles);
    EXPECT_TRUE(result.stitches.empty());
    EXPECT_EQ(result.components, 1U);
    EXPECT_EQ(result.boundary_edges, 0U);
}

TEST(Repair, WeldsEqualPositionsAndTakesMinusZeroForZero)
{
    const IndexedMesh solid = tetrahedron();
    IndexedMesh soup;
    for (const Triangle& triangle : solid.triangles)
    {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t vertex : triangle)
        {
            soup.positions.push_back(solid.positions[vertex]);
        }
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    soup.positions[9][0] = -0.0;
    const RepairedMesh result = repaired(soup);
    EXPECT_EQ(result.report.welded_vertices, 8U);
    EXPECT_EQ(result.mesh.positions.size(), 4U);
    EXPECT_EQ(result.boundary_edges, 0U);
    // The order of the input is kept: the first facet was 0 2 1.
    EXPECT_THAT(
        result.mesh.triangles,
        ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{2, 1, 3}, Triangle{1, 0, 3})
    );
}

TEST(Repair, DropsDegenerateAndDuplicateFacesAndIsolatedVertices)
{
    IndexedMesh mesh = tetrahedron();
    mesh.positions.insert(mesh.positions.begin() + 1, {9.0, 9.0, 9.0});  // used by no face
    mesh.positions.push_back({8.0, 8.0, 8.0});  // used by a degenerate face
    mesh.positions.push_back({1.0, 0.0, 0.0});  // welds with vertex 2
    mesh.triangles = {
        {0, 3, 2}, {0, 2, 4}, {5, 5, 0}, {2, 3, 4}, {4, 3, 2}, {3, 0, 4}, {6, 3, 4}, {2, 6, 3}};
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.isolated_vertices, 2U);
    EXPECT_EQ(result.report.welded_vertices, 1U);
    EXPECT_EQ(result.report.degenerate_faces, 2U);
    EXPECT_EQ(result.report.duplicate_faces, 2U);
    EXPECT_EQ(result.report.flipped_faces, 0U);
    EXPECT_EQ(result.mesh.positions, tetrahedron().positions);
    EXPECT_EQ(result.mesh.triangles, tetrahedron().triangles);
}

TEST(Repair, TurnsTheMinorityOfEachComponent)
{
    IndexedMesh mesh = closed_grid(5, false);
    const auto other = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Point& point : points(other))
    {
        mesh.positions.push_back({point[0], point[1], 7.0});
    }
    const std::vector<Triangle> torus = mesh.triangles;
    for (const auto& [a, b, c] : torus)
    {
        mesh.triangles.push_back({a + other, c + other, b + other});
    }
    const std::vector<Triangle> expected = mesh.triangles;
    for (const std::size_t face : {0U, 7U, 8U, 30U, 55U, 99U})
    {
        std::swap(mesh.triangles[face][1], mesh.triangles[face][2]);
    }
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.flipped_faces, 6U);
    EXPECT_EQ(result.mesh.triangles, expected);
    EXPECT_EQ(result.components, 2U);
}

TEST(Repair, CutsAnEdgeWithThreeFacesAndLocksTheCopiesTogether)
{
    const RepairedMesh result = repaired({points(5), {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}});
    EXPECT_EQ(result.report.non_manifold_edges, 1U);
    EXPECT_EQ(result.report.non_manifold_vertices, 2U);
    EXPECT_EQ(result.report.added_vertices, 4U);
    EXPECT_THAT(
        result.mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{5, 6, 3}, Triangle{7, 8, 4})
    );
    EXPECT_THAT(result.stitches, ElementsAre(0, 1, 2, 3, 4, 1, 0, 0, 1));
    EXPECT_EQ(result.components, 3U);
    EXPECT_EQ(result.boundary_edges, 9U);
}

TEST(Repair, SplitsTwoFansThatMeetInOneVertex)
{
    const RepairedMesh result = repaired({points(5), {{0, 1, 2}, {3, 0, 4}}});
    EXPECT_EQ(result.report.non_manifold_edges, 0U);
    EXPECT_EQ(result.report.non_manifold_vertices, 1U);
    EXPECT_EQ(result.report.added_vertices, 1U);
    EXPECT_THAT(result.mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 5, 4}));
    EXPECT_THAT(result.stitches, ElementsAre(0, 1, 2, 3, 4, 0));
    EXPECT_EQ(result.mesh.positions[5], result.mesh.positions[0]);
}

TEST(Repair, LeavesASheetWholeThatAFinStandsOn)
{
    IndexedMesh mesh = closed_grid(6, false);
    mesh.positions.push_back({0.5, 0.5, 9.0});
    mesh.triangles.push_back({14, 15, 36});
    const RepairedMesh result = repaired(mesh);
    EXPECT_EQ(result.report.non_manifold_edges, 1U);
    EXPECT_EQ(result.report.added_vertices, 2U);
    EXPECT_EQ(result.components, 2U);
    EXPECT_EQ(result.boundary_edges, 3U) << "only the fin has a boundary";
}

TEST(Repair, CutsAMoebiusStripOpenOnce)
{
    EXPECT_TRUE(repaired(ring(12, false)).report.clean());
    const RepairedMesh result = repaired(ring(12, true));
    EXPECT_EQ(result.report.flipped_faces, 0U) << "cut where the faces disagree already";
    EXPECT_EQ(result.report.non_manifold_edges, 1U);
    EXPECT_EQ(result.report.added_vertices, 2U);
    EXPECT_EQ(result.mesh.triangles.size(), 24U);
    EXPECT_EQ(result.components, 1U);
    EXPECT_EQ(result.boundary_edges, 26U);
}

TEST(Repair, CutsAKleinBottleIntoAnOrientableSurface)
{
    EXPECT_TRUE(repaired(closed_grid(6, false)).report.clean());
    const RepairedMesh result = repaired(closed_grid(6, true));
    EXPECT_GT(result.report.non_manifold_edges, 0U);
    EXPECT_EQ(result.mesh.triangles.size(), 72U);
    EXPECT_EQ(result.components, 1U);
    EXPECT_EQ(result.boundary_edges, 2 * result.report.non_manifold_edges);
}

/// Each triangle as its three source vertices in ascending order.
std::multiset<Triangle> source_faces(const RepairedMesh& repaired_mesh)
{
    std::multiset<Triangle> faces;
    for (Triangle triangle : repaired_mesh.mesh.triangles)
    {
        for (std::uint32_t& vertex : triangle)
        {
            vertex = repaired_mesh.stitches.empty() ? vertex : repaired_mesh.stitches[vertex];
        }
        std::sort(triangle.begin(), triangle.end());
        faces.insert(triangle);
    }
    return faces;
}

TEST(Repair, MakesAManifoldOfAnyTrianglesAndReportsTruly)
{
    std::mt19937 generator(11);
    const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
    for (int round = 0; round < 2000; ++round)
    {
        const std::uint32_t vertex_count = 3 + random() % 12;
        IndexedMesh mesh{points(vertex_count), {}};
        if (round % 3 == 0)
        {
            mesh.positions[random() % vertex_count] = mesh.positions[random() % vertex_count];
        }
        const std::uint32_t face_count = 1 + random() % 40;
        for (std::uint32_t i = 0; i < face_count; ++i)
        {
            mesh.triangles.push_back(
                {random() % vertex_count, random() % vertex_count, random() % vertex_count}
            );
        }
        SCOPED_TRACE(testing::Message() << "round " << round);
        const auto result = repair_mesh(mesh);
        if (!result)
        {
            EXPECT_EQ(result.error().code, ErrorCode::EmptyMesh);
            continue;
        }
        const auto valid = check_manifold(result->mesh);
        ASSERT_TRUE(valid) << valid.error().message;
        const RepairReport& report = result->report;
        EXPECT_EQ(
            result->mesh.positions.size(),
            vertex_count - report.welded_vertices - report.isolated_vertices + report.added_vertices
        );
        EXPECT_EQ(
            result->mesh.triangles.size(),
            face_count - report.degenerate_faces - report.duplicate_faces
        );
        EXPECT_EQ(result->stitches.empty(), report.added_vertices == 0);
        const auto faces = source_faces(*result);
        EXPECT_EQ(std::set<Triangle>(faces.begin(), faces.end()).size(), faces.size());
        for (std::size_t vertex = 0; vertex < result->stitches.size(); ++vertex)
        {
            const std::uint32_t source = result->stitches[vertex];
            ASSERT_LE(source, vertex);
            EXPECT_EQ(result->stitches[source], source);
            EXPECT_EQ(result->mesh.positions[vertex], result->mesh.positions[source]);
        }
        const auto again = repair_mesh(mesh);
        EXPECT_EQ(again->mesh.triangles, result->mesh.triangles);
        EXPECT_EQ(again->stitches, result->stitches);
    }
}

TEST(Repair, RefusesBadIndicesBadCoordinatesAndNothingLeft)
{
    IndexedMesh mesh = tetrahedron();
    mesh.triangles[2][1] = 4;
    EXPECT_EQ(repair_mesh(mesh).error().code, ErrorCode::BadIndex);
    mesh = tetrahedron();
    mesh.positions[3][2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(repair_mesh(mesh).error().code, ErrorCode::BadCoordinate);
    mesh.positions[3][2] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(repair_mesh(mesh).error().code, ErrorCode::BadCoordinate);
    EXPECT_EQ(repair_mesh({}).error().code, ErrorCode::EmptyMesh);
    EXPECT_EQ(repair_mesh({points(3), {{0, 1, 1}}}).error().code, ErrorCode::EmptyMesh);
    EXPECT_EQ(repair_mesh({points(3), {}}).error().code, ErrorCode::EmptyMesh);
}

TEST(CheckManifold, NamesEveryKindOfDefect)
{
    const auto message = [](const IndexedMesh& mesh) {
        const auto result = check_manifold(mesh);
        return result ? std::string("valid") : result.error().message;
    };
    EXPECT_EQ(message(tetrahedron()), "valid");
    EXPECT_EQ(message({points(3), {{0, 1, 2}}}), "valid");
    EXPECT_THAT(message({points(3), {}}), HasSubstr("no triangle"));
    EXPECT_THAT(message({points(3), {{0, 1, 3}}}), HasSubstr("face 0 refers"));
    EXPECT_THAT(message({points(3), {{0, 1, 1}}}), HasSubstr("face 0 repeats"));
    EXPECT_THAT(message({points(4), {{0, 1, 2}}}), HasSubstr("no face uses vertex 3"));
    EXPECT_THAT(message({points(4), {{0, 1, 2}, {0, 1, 3}}}), HasSubstr("opposite direction"));
    EXPECT_THAT(message({points(5), {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}}), HasSubstr("3 faces"));
    EXPECT_THAT(message({points(5), {{0, 1, 2}, {0, 3, 4}}}), HasSubstr("vertex 0 has several"));
    // Two copies of a closed surface that meet in a vertex.
    IndexedMesh pair = tetrahedron();
    for (const auto& [a, b, c] : tetrahedron().triangles)
    {
        const auto moved = [](std::uint32_t vertex) { return vertex == 0 ? 0 : vertex + 3; };
        pair.triangles.push_back({moved(a), moved(b), moved(c)});
    }
    pair.positions = points(7);
    EXPECT_THAT(message(pair), HasSubstr("vertex 0 has several"));
}

}  // namespace
}  // namespace vsplit::test
