#include "precompute/collapse_mesh.h"

#include "codec/shapes.h"
#include "precompute/repair.h"
#include "precompute/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace vsplit::test {
namespace {

using precompute::CollapseMesh;
using precompute::OneRing;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr std::uint32_t kAnyValence = 24;

std::uint32_t vertex_count(const IndexedMesh& mesh)
{
    return static_cast<std::uint32_t>(mesh.positions.size());
}

CollapseMesh working(const IndexedMesh& mesh)
{
    return CollapseMesh(vertex_count(mesh), mesh.triangles);
}

OneRing ring_of(const CollapseMesh& mesh, std::uint32_t vertex)
{
    OneRing ring;
    EXPECT_TRUE(mesh.ring(vertex, ring));
    return ring;
}

std::vector<std::uint32_t> neighbours(const OneRing& ring)
{
    return {ring.vertex.begin(), ring.vertex.begin() + static_cast<std::ptrdiff_t>(ring.size)};
}

/// Tells whether `removed` may be folded into its neighbour `kept`.
bool may_collapse(
    const CollapseMesh& mesh,
    std::uint32_t removed,
    std::uint32_t kept,
    std::uint32_t valence_limit = kAnyValence
)
{
    const OneRing ring = ring_of(mesh, removed);
    const auto list = neighbours(ring);
    const auto place = std::ranges::find(list, kept) - list.begin();
    EXPECT_LT(place, static_cast<std::ptrdiff_t>(list.size()));
    return mesh.can_collapse(removed, ring, static_cast<std::size_t>(place), valence_limit);
}

/// The ring, turned so that the smallest neighbour comes first unless it has ends.
std::vector<std::uint32_t> canonical(const OneRing& ring)
{
    auto list = neighbours(ring);
    if (!ring.boundary)
    {
        std::ranges::rotate(list, std::ranges::min_element(list));
    }
    return list;
}

/// By neighbour of the ring the vertex across from the face behind it, or nothing.
std::multiset<std::uint32_t> across(const CollapseMesh& mesh, const OneRing& ring)
{
    std::multiset<std::uint32_t> result;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        if (mesh.face_across(ring.corner[i]) >= 0)
        {
            result.insert(mesh.vertex_across(ring.corner[i]));
        }
    }
    return result;
}

/// Compares everything that a mesh tells with what a mesh newly made of its triangles tells.
void expect_like_rebuilt(const CollapseMesh& mesh, std::uint32_t count)
{
    const auto triangles = mesh.triangles();
    const CollapseMesh rebuilt(count, triangles);
    ASSERT_EQ(mesh.vertices(), rebuilt.vertices());
    for (const std::uint32_t v : mesh.vertices())
    {
        ASSERT_EQ(mesh.valence(v), rebuilt.valence(v)) << "vertex " << v;
        ASSERT_EQ(mesh.is_boundary(v), rebuilt.is_boundary(v)) << "vertex " << v;
        OneRing ring;
        OneRing wanted;
        ASSERT_EQ(mesh.ring(v, ring), rebuilt.ring(v, wanted));
        if (mesh.valence(v) <= OneRing::kMost)
        {
            ASSERT_EQ(canonical(ring), canonical(wanted)) << "vertex " << v;
            ASSERT_EQ(ring.face_count, wanted.face_count);
            ASSERT_EQ(across(mesh, ring), across(rebuilt, wanted)) << "vertex " << v;
        }
    }
}

/// A manifold whose every vertex is used, once the vertices are numbered without gaps.
void expect_manifold(const CollapseMesh& mesh)
{
    const auto alive = mesh.vertices();
    IndexedMesh packed{{}, mesh.triangles()};
    packed.positions.resize(alive.size());
    for (Triangle& t : packed.triangles)
    {
        for (std::uint32_t& v : t)
        {
            v = static_cast<std::uint32_t>(std::ranges::lower_bound(alive, v) - alive.begin());
        }
    }
    const auto checked = precompute::check_manifold(packed);
    ASSERT_TRUE(checked.has_value()) << describe(checked.error());
}

TEST(CollapseMesh, WalksARingCounterClockwise)
{
    const CollapseMesh mesh = working(fan(5));
    const OneRing hub = ring_of(mesh, 0);
    EXPECT_FALSE(hub.boundary);
    EXPECT_EQ(hub.face_count, 5U);
    EXPECT_THAT(canonical(hub), ElementsAre(1, 2, 3, 4, 5));
}

TEST(CollapseMesh, WalksABoundaryRingFromEndToEnd)
{
    const CollapseMesh mesh = working(fan(5));
    const OneRing rim = ring_of(mesh, 1);
    EXPECT_TRUE(rim.boundary);
    EXPECT_EQ(rim.face_count, 2U);
    EXPECT_THAT(neighbours(rim), ElementsAre(2, 0, 5));
    EXPECT_EQ(mesh.valence(1), 3U);
    EXPECT_TRUE(mesh.is_boundary(1));
    EXPECT_FALSE(mesh.is_boundary(0));
}

TEST(CollapseMesh, DoesNotWalkHugeRings)
{
    OneRing ring;
    EXPECT_TRUE(working(fan(OneRing::kMost)).ring(0, ring));
    EXPECT_FALSE(working(fan(OneRing::kMost + 1)).ring(0, ring));
    EXPECT_EQ(working(fan(400)).valence(0), 400U);
}

TEST(CollapseMesh, KeepsTheLastTriangleAndTheLastTetrahedron)
{
    for (const IndexedMesh& shape : {triangle(), tetrahedron()})
    {
        const CollapseMesh mesh = working(shape);
        for (const std::uint32_t v : mesh.vertices())
        {
            for (const std::uint32_t other : neighbours(ring_of(mesh, v)))
            {
                EXPECT_FALSE(may_collapse(mesh, v, other));
            }
        }
    }
}

TEST(CollapseMesh, TurnsAnOctahedronIntoATetrahedron)
{
    CollapseMesh mesh = working(octahedron());
    ASSERT_TRUE(may_collapse(mesh, 0, 2));
    const OneRing ring = ring_of(mesh, 0);
    const auto list = neighbours(ring);
    mesh.collapse(0, ring, static_cast<std::size_t>(std::ranges::find(list, 2U) - list.begin()));
    EXPECT_TRUE(mesh.is_removed(0));
    EXPECT_THAT(mesh.vertices(), ElementsAre(1, 2, 3, 4, 5));
    EXPECT_EQ(mesh.triangles().size(), 6U);
    expect_like_rebuilt(mesh, 6);
    expect_manifold(mesh);
    // What is left is a double pyramid; its tips have valence 3, so their edges may go.
    std::size_t legal = 0;
    for (const std::uint32_t v : mesh.vertices())
    {
        for (const std::uint32_t other : neighbours(ring_of(mesh, v)))
        {
            legal += may_collapse(mesh, v, other) ? 1 : 0;
        }
    }
    EXPECT_GT(legal, 0U);
}

TEST(CollapseMesh, KeepsANeckOfThreeEdges)
{
    // Round the tube of the torus there are three vertices only: its edges have a common neighbour
    // that is in no face with them (link condition).
    const CollapseMesh mesh = working(torus(9, 3, 0.0, 0));
    for (std::uint32_t i = 0; i < 9; ++i)
    {
        for (std::uint32_t j = 0; j < 3; ++j)
        {
            EXPECT_FALSE(may_collapse(mesh, i * 3 + j, i * 3 + (j + 1) % 3));
        }
    }
    EXPECT_TRUE(may_collapse(mesh, 0, 3));
}

TEST(CollapseMesh, KeepsAHoleOfThreeEdges)
{
    IndexedMesh shape = sphere(6, 8, 0.0, 0);
    const Triangle hole = shape.triangles.back();
    shape.triangles.pop_back();
    const CollapseMesh mesh = working(shape);
    for (std::size_t k = 0; k < 3; ++k)
    {
        EXPECT_FALSE(may_collapse(mesh, hole[k], hole[(k + 1) % 3]));
        EXPECT_FALSE(may_collapse(mesh, hole[(k + 1) % 3], hole[k]));
    }
}

TEST(CollapseMesh, ShortensABoundary)
{
    CollapseMesh mesh = working(fan(6));
    const OneRing ring = ring_of(mesh, 3);
    ASSERT_THAT(neighbours(ring), ElementsAre(4, 0, 2));
    for (const std::size_t kept : {0U, 2U})
    {
        EXPECT_TRUE(mesh.can_collapse(3, ring, kept, kAnyValence));
    }
    mesh.collapse(3, ring, 2);
    EXPECT_EQ(mesh.triangles().size(), 5U);
    EXPECT_EQ(mesh.valence(0), 5U);
    EXPECT_EQ(mesh.valence(2), 3U);
    EXPECT_THAT(neighbours(ring_of(mesh, 2)), UnorderedElementsAre(1, 4, 0));
    expect_like_rebuilt(mesh, 7);
    expect_manifold(mesh);
}

TEST(CollapseMesh, FoldsAnInnerVertexIntoTheBoundary)
{
    CollapseMesh mesh = working(fan(6));
    const OneRing ring = ring_of(mesh, 0);
    ASSERT_TRUE(mesh.can_collapse(0, ring, 0, kAnyValence));
    mesh.collapse(0, ring, 0);
    EXPECT_EQ(mesh.triangles().size(), 4U);
    EXPECT_EQ(mesh.valence(ring.vertex[0]), 5U);
    expect_like_rebuilt(mesh, 7);
    expect_manifold(mesh);
}

TEST(CollapseMesh, ObeysTheValenceLimit)
{
    const CollapseMesh mesh = working(torus(8, 8, 0.0, 0));
    const std::uint32_t kept = neighbours(ring_of(mesh, 0)).front();
    // Both have six neighbours: 6 + 6 - 4 stay.
    EXPECT_FALSE(may_collapse(mesh, 0, kept, 7));
    EXPECT_TRUE(may_collapse(mesh, 0, kept, 8));
}

TEST(CollapseMesh, NeverFoldsIntoAHub)
{
    EXPECT_FALSE(may_collapse(working(fan(400)), 1, 0, 1000000));
}

/// Carries out random legal collapses, checking now and then.
void collapse_at_random(const IndexedMesh& shape, unsigned seed)
{
    SCOPED_TRACE(seed);
    const std::uint32_t count = vertex_count(shape);
    CollapseMesh mesh = working(shape);
    expect_like_rebuilt(mesh, count);
    std::mt19937 random(seed);
    std::size_t done = 0;
    for (std::uint32_t attempt = 0; attempt < 20 * count; ++attempt)
    {
        const auto v = static_cast<std::uint32_t>(random() % count);
        OneRing ring;
        if (mesh.is_removed(v) || !mesh.ring(v, ring) || ring.size < 3)
        {
            continue;
        }
        std::size_t kept = random() % ring.size;
        kept = ring.boundary ? (kept % 2 == 0 ? 0 : ring.size - 1) : kept;
        if (!mesh.can_collapse(v, ring, kept, 12))
        {
            continue;
        }
        mesh.collapse(v, ring, kept);
        if (++done % 10 == 0)
        {
            ASSERT_NO_FATAL_FAILURE(expect_like_rebuilt(mesh, count));
            ASSERT_NO_FATAL_FAILURE(expect_manifold(mesh));
        }
    }
    EXPECT_GT(done, count / 4);
    expect_like_rebuilt(mesh, count);
    expect_manifold(mesh);
}

TEST(CollapseMesh, StaysConsistentAfterRandomCollapses)
{
    for (unsigned seed = 0; seed < 6; ++seed)
    {
        collapse_at_random(torus(12, 7, 0.0, 0), seed);
        collapse_at_random(sphere(8, 9, 0.0, 0), seed);
        collapse_at_random(height_field(10, 9, 0.0, seed), seed);
        const auto holes = with_holes(height_field(12, 10, 0.0, seed), 0.1, seed);
        collapse_at_random(precompute::repair_mesh(holes)->mesh, seed);
    }
}

}  // namespace
}  // namespace vsplit::test
