#include "precompute/half_edge_mesh.h"

#include "precompute/mesh_files.h"
#include "precompute/validate.h"

#include <gmock/gmock.h>

#include <numeric>
#include <random>
#include <set>

namespace vsplit::test {
namespace {

using precompute::boundary_edge_count;
using precompute::component_count;
using precompute::HalfEdgeMesh;
using precompute::make_half_edge_mesh;
using precompute::vertex_handle;
using ::testing::UnorderedElementsAre;

std::vector<int> neighbours(const HalfEdgeMesh& mesh, std::uint32_t vertex)
{
    std::vector<int> found;
    for (const auto neighbour : mesh.vv_range(vertex_handle(vertex)))
    {
        found.push_back(neighbour.idx());
    }
    return found;
}

/// The triangles of a half-edge mesh by its own circulators.
std::vector<Triangle> triangles_of(const HalfEdgeMesh& mesh)
{
    std::vector<Triangle> triangles;
    for (const auto face : mesh.faces())
    {
        auto corner = mesh.cfv_iter(face);
        Triangle& triangle = triangles.emplace_back();
        for (std::uint32_t& vertex : triangle)
        {
            vertex = static_cast<std::uint32_t>((corner++)->idx());
        }
    }
    return triangles;
}

/// A closed fan of triangles round vertex 0, in random order.
IndexedMesh wheel(std::uint32_t spokes)
{
    IndexedMesh mesh{std::vector<std::array<double, 3>>(spokes + 1), {}};
    for (std::uint32_t i = 0; i < spokes; ++i)
    {
        mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
    }
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(3));
    return mesh;
}

TEST(HalfEdgeMesh, KeepsVerticesAndFacesAsTheyWere)
{
    IndexedMesh source = tetrahedron();
    source.positions[2] = {0.1, 1.0 / 3.0, -1e-17};
    const auto mesh = make_half_edge_mesh(source);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(triangles_of(*mesh), source.triangles);
    EXPECT_EQ(mesh->n_edges(), 6U);
    for (std::uint32_t vertex = 0; vertex < 4; ++vertex)
    {
        const auto& point = mesh->point(vertex_handle(vertex));
        EXPECT_EQ((std::array{point[0], point[1], point[2]}), source.positions[vertex]);
    }
    EXPECT_THAT(neighbours(*mesh, 0), UnorderedElementsAre(1, 2, 3));
}

TEST(HalfEdgeMesh, CirculatesBoundariesFromOneEndToTheOther)
{
    // A strip of three triangles: 0-1 | 2-3 | 4 .
    const auto mesh = make_half_edge_mesh(
        {std::vector<std::array<double, 3>>(5), {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}}
    );
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(boundary_edge_count(*mesh), 5U);
    EXPECT_THAT(neighbours(*mesh, 2), UnorderedElementsAre(0, 1, 3, 4));
    EXPECT_TRUE(mesh->is_boundary(vertex_handle(2)));
    // The outline in five steps along half-edges without a face.
    auto half = mesh->halfedge_handle(vertex_handle(0));
    std::set<int> outline;
    for (int step = 0; step < 5; ++step)
    {
        EXPECT_TRUE(mesh->is_boundary(half));
        outline.insert(mesh->from_vertex_handle(half).idx());
        half = mesh->next_halfedge_handle(half);
    }
    EXPECT_EQ(outline.size(), 5U);
    EXPECT_EQ(half, mesh->halfedge_handle(vertex_handle(0)));
}

TEST(HalfEdgeMesh, CountsComponentsAndBoundaryEdges)
{
    IndexedMesh source = tetrahedron();
    source.positions.resize(10);
    source.triangles.push_back({4, 5, 6});
    source.triangles.push_back({7, 8, 9});
    const auto mesh = make_half_edge_mesh(source);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(component_count(*mesh), 3U);
    EXPECT_EQ(boundary_edge_count(*mesh), 6U);
}

TEST(HalfEdgeMesh, TakesAHubWhoseTrianglesComeInAnyOrder)
{
    // With time in the square of the valence this would run into the test's time limit.
    const std::uint32_t spokes = 400000;
    const auto mesh = make_half_edge_mesh(wheel(spokes));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->valence(vertex_handle(0)), spokes);
    EXPECT_EQ(boundary_edge_count(*mesh), spokes);
}

/// Whether a mesh is a manifold, by definition: used vertices, no directed edge twice, and the
/// neighbours of every vertex in one chain or one cycle.
bool is_manifold(const IndexedMesh& mesh)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> links(mesh.positions.size());
    for (const Triangle& triangle : mesh.triangles)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::uint32_t a = triangle[i];
            const std::uint32_t b = triangle[(i + 1) % 3];
            if (a == b || !directed.insert({a, b}).second)
            {
                return false;
            }
            links[a].emplace_back(b, triangle[(i + 2) % 3]);
        }
    }
    return std::all_of(links.begin(), links.end(), [](auto& link) {
        // Walks the triangles round a vertex backwards, then forwards.
        std::set<std::size_t> reached;
        for (const bool forwards : {false, true})
        {
            std::size_t at = 0;
            while (at < link.size())
            {
                reached.insert(at);
                const std::uint32_t edge = forwards ? link[at].second : link[at].first;
                const auto next = std::find_if(link.begin(), link.end(), [&](const auto& other) {
                    return (forwards ? other.first : other.second) == edge;
                });
                at = static_cast<std::size_t>(next - link.begin());
                at = reached.contains(at) ? link.size() : at;
            }
        }
        return !link.empty() && reached.size() == link.size();
    });
}

TEST(HalfEdgeMesh, SucceedsForManifoldsAndForNothingElse)
{
    std::mt19937 generator(11);
    const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
    int manifolds = 0;
    for (int round = 0; round < 20000; ++round)
    {
        const std::uint32_t vertex_count = 3 + random() % 4;
        IndexedMesh mesh{std::vector<std::array<double, 3>>(vertex_count), {}};
        const std::uint32_t face_count = 1 + random() % 5;
        for (std::uint32_t i = 0; i < face_count; ++i)
        {
            std::vector<std::uint32_t> corners(vertex_count);
            std::iota(corners.begin(), corners.end(), 0U);
            std::shuffle(corners.begin(), corners.end(), generator);
            mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        }
        SCOPED_TRACE(testing::Message() << "round " << round);
        const auto linked = make_half_edge_mesh(mesh);
        ASSERT_EQ(linked.has_value(), is_manifold(mesh));
        ASSERT_EQ(precompute::check_manifold(mesh).has_value(), linked.has_value());
        if (linked)
        {
            ++manifolds;
            ASSERT_EQ(triangles_of(*linked), mesh.triangles);
        }
    }
    EXPECT_GT(manifolds, 500);
}

}  // namespace
}  // namespace vsplit::test
