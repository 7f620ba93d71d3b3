#include "codec/refinement_mesh.h"

#include "codec/shapes.h"
#include "codec/split_updates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace vsplit::test {
namespace {

using codec::Corner;
using codec::next_corner;
using codec::previous_corner;
using codec::RefinementMesh;
using codec::Split;
using codec::SplitKind;

constexpr std::int32_t kMost = 1000;

GridMesh on_grid(const IndexedMesh& mesh)
{
    GridMesh grid{{}, mesh.triangles};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    {
        const auto n = static_cast<std::int32_t>(i);
        grid.positions.push_back({n, n * n % kMost, 3 * n % kMost});
    }
    return grid;
}

Result<void> set_base(RefinementMesh& mesh, const GridMesh& base, std::uint32_t room = 10)
{
    mesh.reserve(
        static_cast<std::uint32_t>(base.positions.size()) + room,
        static_cast<std::uint32_t>(base.triangles.size()) + 2 * room
    );
    return mesh.set_base(base, kMost);
}

void expect_refused(const GridMesh& base)
{
    RefinementMesh mesh;
    const auto done = set_base(mesh, base);
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, ErrorCode::BadChunk);
    EXPECT_EQ(mesh.vertex_count(), 0U);
    EXPECT_EQ(mesh.face_count(), 0U);
}

/// Opposite corners point at each other and see the same edge; valences count the neighbours.
void expect_consistent(RefinementMesh& mesh)
{
    std::vector<std::vector<std::uint32_t>> neighbours(mesh.vertex_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    {
        for (Corner k = 0; k < 3; ++k)
        {
            const Corner corner = static_cast<Corner>(f) * 4 + k;
            const std::uint32_t from = mesh.vertex(next_corner(corner));
            const std::uint32_t to = mesh.vertex(previous_corner(corner));
            neighbours[from].push_back(to);
            neighbours[to].push_back(from);
            const Corner across = mesh.opposite(corner);
            if (across >= 0)
            {
                EXPECT_EQ(mesh.opposite(across), corner);
                EXPECT_EQ(mesh.vertex(next_corner(across)), to);
                EXPECT_EQ(mesh.vertex(previous_corner(across)), from);
            }
        }
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    {
        auto& list = neighbours[v];
        std::ranges::sort(list);
        const auto extra = std::ranges::unique(list);
        list.erase(extra.begin(), extra.end());
        EXPECT_EQ(mesh.valences()[v], list.size()) << "vertex " << v;
    }
}

TEST(Corners, GoRoundTheirFace)
{
    for (const Corner face : {0, 1, 77, (1 << 29) - 3})
    {
        EXPECT_EQ(next_corner(4 * face), 4 * face + 1);
        EXPECT_EQ(next_corner(4 * face + 1), 4 * face + 2);
        EXPECT_EQ(next_corner(4 * face + 2), 4 * face);
        for (Corner k = 0; k < 3; ++k)
        {
            EXPECT_EQ(previous_corner(next_corner(4 * face + k)), 4 * face + k);
            EXPECT_EQ(codec::face_of(4 * face + k), face);
        }
    }
    EXPECT_EQ(codec::face_of(-1), -1);
}

TEST(RefinementMesh, LinksManifolds)
{
    for (const IndexedMesh& shape :
         {triangle(),
          tetrahedron(),
          octahedron(),
          strip(5),
          fan(300),
          double_cone(300),
          joined(tetrahedron(), strip(3), 2.0),
          torus(5, 4, 0.0, 0)})
    {
        RefinementMesh mesh;
        ASSERT_TRUE(set_base(mesh, on_grid(shape)).has_value());
        EXPECT_EQ(mesh.vertex_count(), shape.positions.size());
        EXPECT_EQ(mesh.face_count(), shape.triangles.size());
        expect_consistent(mesh);
    }
}

TEST(RefinementMesh, RefusesIndicesThatDoNotExist)
{
    GridMesh base = on_grid(tetrahedron());
    base.triangles[2][1] = 4;
    expect_refused(base);
    base.triangles[2][1] = 0xFFFFFFFF;
    expect_refused(base);
}

TEST(RefinementMesh, RefusesTrianglesThatRepeatAVertex)
{
    for (std::size_t k = 0; k < 3; ++k)
    {
        GridMesh base = on_grid(tetrahedron());
        base.triangles[1][k] = base.triangles[1][(k + 1) % 3];
        expect_refused(base);
    }
}

TEST(RefinementMesh, RefusesPositionsBeyondTheGrid)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        for (const std::int32_t bad : {-1, kMost + 1, 2147483647, -2147483647 - 1})
        {
            GridMesh base = on_grid(tetrahedron());
            base.positions[3][axis] = bad;
            expect_refused(base);
        }
    }
}

TEST(RefinementMesh, RefusesVerticesThatNoTriangleUses)
{
    GridMesh base = on_grid(tetrahedron());
    base.positions.push_back({1, 2, 3});
    expect_refused(base);
}

TEST(RefinementMesh, RefusesFacesThatTurnOppositeWays)
{
    GridMesh base = on_grid(tetrahedron());
    std::swap(base.triangles[0][0], base.triangles[0][1]);
    expect_refused(base);
}

TEST(RefinementMesh, RefusesEdgesOfThreeFaces)
{
    GridMesh base = on_grid(tetrahedron());
    base.positions.push_back({1, 2, 3});
    base.triangles.push_back({0, 1, 4});
    expect_refused(base);
}

TEST(RefinementMesh, RefusesFansThatMeetInOneVertex)
{
    // Two tetrahedra, and two open fans, that share vertex 0.
    GridMesh base = on_grid(joined(tetrahedron(), tetrahedron(), 2.0));
    for (Triangle& face : base.triangles)
    {
        std::ranges::replace(face, 4U, 0U);
        std::ranges::replace(face, 7U, 4U);
    }
    base.positions.pop_back();
    expect_refused(base);
    base = on_grid(joined(triangle(), triangle(), 2.0));
    base.triangles[1] = {0, 3, 4};
    base.positions.pop_back();
    expect_refused(base);
}

/// Splits one vertex and checks what comes out against the drawing at Split.
void expect_split(const IndexedMesh& shape, Split split, std::size_t added)
{
    RefinementMesh mesh;
    ASSERT_TRUE(set_base(mesh, on_grid(shape)).has_value());
    mesh.start_batch();
    const std::uint32_t kept = mesh.vertex(split.first);
    const std::uint32_t right = mesh.vertex(next_corner(split.first));
    const std::vector<Split> splits{split};
    EXPECT_EQ(RefinementMesh::added_faces(splits), added);
    std::vector<codec::TriangleUpdate> updates;
    codec::SplitUpdates source(mesh);
    source.show(splits);
    mesh.apply(splits);
    for (const codec::TriangleUpdate& update : codec::TriangleUpdates(source))
    {
        updates.push_back(update);
    }
    const auto removed = static_cast<std::uint32_t>(shape.positions.size());
    EXPECT_EQ(mesh.vertex_count(), removed + 1);
    EXPECT_EQ(mesh.face_count(), shape.triangles.size() + added);
    EXPECT_EQ(updates.size(), split.wedge + added);

    std::vector<Triangle> triangles = shape.triangles;
    triangles.resize(mesh.face_count());
    for (const codec::TriangleUpdate& update : updates)
    {
        triangles[update.slot] = update.vertices;
        EXPECT_THAT(update.vertices, ::testing::Contains(removed));
    }
    mesh.start_batch();
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    {
        EXPECT_EQ(mesh.faces()[f].vertex, triangles[mesh.faces()[f].slot]);
    }
    // The valences of the ring are the connectivity coder's; here only the links are of interest.
    GridMesh rebuilt = on_grid(shape);
    rebuilt.positions.push_back({1, 1, 1});
    rebuilt.triangles = triangles;
    RefinementMesh again;
    ASSERT_TRUE(set_base(again, rebuilt).has_value());
    EXPECT_EQ(again.valences()[removed], split.wedge + 2);
    const Triangle first_new = triangles[shape.triangles.size()];
    if (split.kind != SplitKind::BoundaryRight)
    {
        EXPECT_EQ(first_new, (Triangle{kept, right, removed}));
    }
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    {
        for (Corner k = 0; k < 3; ++k)
        {
            const Corner corner = static_cast<Corner>(f) * 4 + k;
            const Corner across = mesh.opposite(corner);
            const auto slot = static_cast<Corner>(mesh.faces()[f].slot) * 4 + k;
            ASSERT_EQ(across < 0, again.opposite(slot) < 0);
            ASSERT_TRUE(across < 0 || mesh.opposite(across) == corner);
            ASSERT_TRUE(across < 0 || mesh.vertex(across) == again.vertex(again.opposite(slot)));
        }
    }
}

TEST(RefinementMesh, PutsNewFacesBesideTheirSeeds)
{
    // Faces 0 .. 8 round vertex 0; the seeds are faces 1, 4 and 5.
    const GridMesh base = on_grid(fan(9));
    const std::vector<Split> splits{
        {.first = 0, .wedge = 3, .before = 1},
        {.first = 4 * 4 + 2, .wedge = 1, .kind = SplitKind::BoundaryLeft},
        {.first = 4 * 5, .wedge = 2},
    };
    const std::vector<std::uint32_t> expected{0, 1, 9, 10, 2, 3, 4, 11, 5, 12, 13, 6, 7, 8};
    for (const std::uint32_t room : {5U, 7U, 10U, 100U})  // of 5, none is left
    {
        RefinementMesh mesh;
        mesh.reserve(20, 9 + room);
        ASSERT_TRUE(mesh.set_base(base, kMost).has_value());
        mesh.start_batch();
        mesh.apply(std::span(splits).first(1));
        mesh.apply(std::span(splits).subspan(1));
        EXPECT_EQ(mesh.added_count(), 5U);
        mesh.start_batch();
        EXPECT_EQ(mesh.added_count(), 0U);
        ASSERT_EQ(mesh.face_count(), expected.size());
        std::vector<std::uint32_t> slots;
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        {
            slots.push_back(mesh.faces()[f].slot);
            for (Corner k = 0; k < 3; ++k)
            {
                const Corner corner = static_cast<Corner>(f) * 4 + k;
                const Corner across = mesh.opposite(corner);
                EXPECT_TRUE(across < 0 || mesh.opposite(across) == corner);
                EXPECT_TRUE(
                    across < 0 ||
                    mesh.vertex(next_corner(across)) == mesh.vertex(previous_corner(corner))
                );
            }
        }
        EXPECT_EQ(slots, expected) << "room for " << room;
    }
}

TEST(RefinementMesh, OpensAWedgeInside)
{
    // Face k of a fan is (0, k + 1, k + 2).
    for (std::uint8_t wedge = 1; wedge <= codec::kMaxWedge; ++wedge)
    {
        expect_split(fan(7), {.first = 4 * 2, .wedge = wedge, .kind = SplitKind::Interior}, 2);
        expect_split(fan(7), {.first = 4 * 5, .wedge = wedge, .kind = SplitKind::Interior}, 2);
    }
}

TEST(RefinementMesh, OpensAWedgeAtTheBoundary)
{
    IndexedMesh open = fan(6);
    open.triangles.pop_back();  // faces 0 .. 4 round vertex 0, from vertex 1 to vertex 6
    expect_split(open, {.first = 0, .wedge = 2, .kind = SplitKind::BoundaryRight}, 1);
    expect_split(open, {.first = 0, .wedge = 2, .kind = SplitKind::Interior}, 2);
    expect_split(open, {.first = 4 * 3, .wedge = 2, .kind = SplitKind::BoundaryLeft}, 1);
    expect_split(open, {.first = 4 * 3, .wedge = 2, .kind = SplitKind::Interior}, 2);
}

TEST(RefinementMesh, OpensTheOnlyTriangle)
{
    expect_split(triangle(), {.first = 1, .wedge = 1, .kind = SplitKind::Interior}, 2);
    expect_split(triangle(), {.first = 1, .wedge = 1, .kind = SplitKind::BoundaryLeft}, 1);
    expect_split(triangle(), {.first = 1, .wedge = 1, .kind = SplitKind::BoundaryRight}, 1);
}

TEST(RefinementMesh, TakesPartsBehindWhatABatchMade)
{
    RefinementMesh mesh;
    ASSERT_TRUE(set_base(mesh, on_grid(fan(7)), 30).has_value());
    mesh.start_batch();
    const std::vector<Split> splits{{.first = 8, .wedge = 2, .kind = SplitKind::Interior}};
    mesh.points()[8] = {1.0F, 2.0F, 3.0F};
    mesh.apply(splits);
    ++mesh.valences()[3];  // as the connectivity coder does
    ++mesh.valences()[5];
    const std::uint32_t faces = mesh.face_count();
    ASSERT_TRUE(mesh.add_parts(on_grid(joined(tetrahedron(), strip(3), 2.0)), kMost).has_value());
    EXPECT_EQ(mesh.vertex_count(), 9U + 4U + 8U);
    EXPECT_EQ(mesh.face_count(), faces + 4U + 6U);
    expect_consistent(mesh);
    for (std::uint32_t f = faces; f < mesh.face_count(); ++f)
    {
        EXPECT_EQ(mesh.faces()[f].slot, f);
        EXPECT_GE(*std::ranges::min_element(mesh.faces()[f].vertex), 9U);
    }
    mesh.start_batch();
    expect_consistent(mesh);
}

TEST(RefinementMesh, StaysAsItWasWhenPartsAreRefused)
{
    RefinementMesh mesh;
    ASSERT_TRUE(set_base(mesh, on_grid(octahedron()), 30).has_value());
    GridMesh beyond = on_grid(tetrahedron());
    beyond.positions[1][2] = kMost + 1;
    GridMesh twice = on_grid(tetrahedron());
    twice.triangles.push_back(twice.triangles.front());
    GridMesh loose = on_grid(tetrahedron());
    loose.positions.push_back({1, 1, 1});
    GridMesh known = on_grid(tetrahedron());
    known.triangles[0][0] = 4;
    for (const GridMesh& bad : {beyond, twice, loose, known})
    {
        const auto done = mesh.add_parts(bad, kMost);
        ASSERT_FALSE(done.has_value());
        EXPECT_EQ(done.error().code, ErrorCode::BadChunk);
        EXPECT_EQ(mesh.vertex_count(), 6U);
        EXPECT_EQ(mesh.face_count(), 8U);
        expect_consistent(mesh);
    }
}

}  // namespace
}  // namespace vsplit::test
