#include "core/file_io.h"
#include "make_assets/models.h"
#include "make_assets/vase.h"
#include "make_assets/vector3.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"
#include "precompute/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>

namespace vsplit::assets {
namespace {

using precompute::RepairedMesh;

struct Advertised
{
    std::string_view name;
    std::uint32_t vertices;
    std::uint32_t faces;
    std::uint32_t components;
    std::uint32_t boundary_edges;
    int genus;  // of all components together
};

std::ostream& operator<<(std::ostream& out, const Advertised& model)
{
    return out << model.name;
}

std::filesystem::path path_of(std::string_view name)
{
    return std::filesystem::path(VSPLIT_SOURCE_DIR) / "assets" / (std::string(name) + ".ply");
}

IndexedMesh read_asset(std::string_view name)
{
    auto mesh = precompute::read_mesh(path_of(name));
    EXPECT_TRUE(mesh.has_value()) << name;
    return mesh.has_value() ? *std::move(mesh) : IndexedMesh{};
}

IndexedMesh make_again(std::string_view name)
{
    const auto model = std::find_if(kModels.begin(), kModels.end(), [&](const Model& candidate) {
        return candidate.name == name;
    });
    return model->make();
}

class CommittedModel : public testing::TestWithParam<Advertised>
{
};

// The table of assets/README.md, without the dirty model.
INSTANTIATE_TEST_SUITE_P(
    Clean,
    CommittedModel,
    testing::Values(
        Advertised{"bone", 10094, 20184, 1, 0, 0},
        Advertised{"beast", 14133, 28262, 1, 0, 0},
        Advertised{"bracket", 3453, 6914, 1, 0, 3},
        Advertised{"terrain", 11271, 22252, 1, 288, 0},
        Advertised{"pair", 10732, 21464, 2, 0, 2}
    ),
    [](const auto& parameter) { return std::string(parameter.param.name); }
);

TEST_P(CommittedModel, HasTheAdvertisedCountsAndTopology)
{
    const Advertised& wanted = GetParam();
    const IndexedMesh mesh = read_asset(wanted.name);
    EXPECT_EQ(mesh.positions.size(), wanted.vertices);
    EXPECT_EQ(mesh.triangles.size(), wanted.faces);
    ASSERT_TRUE(precompute::check_manifold(mesh).has_value());
    const auto repaired = precompute::repair_mesh(mesh);
    ASSERT_TRUE(repaired.has_value());
    EXPECT_TRUE(repaired->report.clean());
    EXPECT_EQ(repaired->components, wanted.components);
    EXPECT_EQ(repaired->boundary_edges, wanted.boundary_edges);
    // Euler: V - E + F = 2 (components - genus) - boundaries, and the terrain has one boundary.
    const auto edges = (3 * mesh.triangles.size() + wanted.boundary_edges) / 2;
    const auto euler = static_cast<int>(mesh.positions.size()) - static_cast<int>(edges) +
                       static_cast<int>(mesh.triangles.size());
    const int boundaries = wanted.boundary_edges > 0 ? 1 : 0;
    EXPECT_EQ(euler, 2 * (static_cast<int>(wanted.components) - wanted.genus) - boundaries);
}

TEST_P(CommittedModel, IsDocumentedWithItsCounts)
{
    std::ifstream file(std::filesystem::path(VSPLIT_SOURCE_DIR) / "assets/README.md");
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const Advertised& model = GetParam();
    const std::string row = "| `" + std::string(model.name) + ".ply` | " +
                            std::to_string(model.vertices) + " | " + std::to_string(model.faces) +
                            " |";
    EXPECT_THAT(text, testing::HasSubstr(row));
}

TEST_P(CommittedModel, HasNoDegenerateFaceAndLooksOutwards)
{
    const IndexedMesh mesh = read_asset(GetParam().name);
    double volume = 0.0;
    for (const auto& [i, j, k] : mesh.triangles)
    {
        const Vector3 a = to_vector(mesh.positions[i]);
        const Vector3 b = to_vector(mesh.positions[j]);
        const Vector3 c = to_vector(mesh.positions[k]);
        const Vector3 normal = cross(b - a, c - a);
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        ASSERT_GT(length(normal), 1e-3 * longest * longest);
        volume += dot(a, cross(b, c));
    }
    EXPECT_GT(volume, 0.0);  // of the terrain: above the plane through the origin
}

TEST_P(CommittedModel, IsWhatTheGeneratorMakes)
{
    const IndexedMesh committed = read_asset(GetParam().name);
    const IndexedMesh made = make_again(GetParam().name);
    ASSERT_EQ(made.triangles, committed.triangles);
    ASSERT_EQ(made.positions.size(), committed.positions.size());
    for (std::size_t v = 0; v < made.positions.size(); ++v)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double size = 1.0 + std::abs(made.positions[v][axis]);
            ASSERT_NEAR(made.positions[v][axis], committed.positions[v][axis], 1e-6 * size) << v;
        }
    }
}

std::string read_text(std::string_view name)
{
    const auto bytes = read_file(std::filesystem::path(VSPLIT_SOURCE_DIR) / "assets" / name);
    EXPECT_TRUE(bytes.has_value()) << name;
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

TEST(VaseModel, IsWhatTheGeneratorMakes)
{
    EXPECT_EQ(obj_text(make_vase(), "vase.mtl", {"clay", "glaze"}), read_text("vase.obj"));
    EXPECT_EQ(vase_mtl(), read_text("vase.mtl"));
    const auto png = vase_png();
    EXPECT_EQ(
        std::string(reinterpret_cast<const char*>(png.data()), png.size()), read_text("vase.png")
    );
}

TEST(VaseModel, HasSeamsHardEdgesColoursAndTwoGroups)
{
    const auto model =
        precompute::read_surface(std::filesystem::path(VSPLIT_SOURCE_DIR) / "assets/vase.obj");
    ASSERT_TRUE(model.has_value());
    const Surface& vase = model->surface;
    EXPECT_EQ(vase.mesh.positions.size(), 1026U);
    EXPECT_EQ(vase.mesh.triangles.size(), 2048U);
    EXPECT_TRUE(precompute::check_manifold(vase.mesh).has_value());
    ASSERT_EQ(vase.attributes.size(), 3U);
    for (const SurfaceAttribute& attribute : vase.attributes)
    {
        const bool seams = attribute.kind != AttributeKind::Color;
        EXPECT_EQ(attribute.size() > vase.mesh.positions.size(), seams);
    }
    EXPECT_THAT(vase.groups, testing::Contains(1U));
    EXPECT_THAT(vase.groups, testing::Contains(0U));
    EXPECT_EQ(model->images.size(), 1U);
}

TEST(DirtyModel, IsWhatTheGeneratorMakes)
{
    const IndexedMesh committed = read_asset("dirty");
    const IndexedMesh made = make_again("dirty");
    EXPECT_EQ(made.triangles, committed.triangles);
    EXPECT_EQ(made.positions.size(), committed.positions.size());
}

TEST(DirtyModel, HasEveryDefectThatItAdvertises)
{
    const IndexedMesh mesh = read_asset("dirty");
    EXPECT_EQ(mesh.positions.size(), 2516U);
    EXPECT_EQ(mesh.triangles.size(), 4916U);
    EXPECT_FALSE(precompute::check_manifold(mesh).has_value());
    const auto repaired = precompute::repair_mesh(mesh);
    ASSERT_TRUE(repaired.has_value());
    EXPECT_EQ(repaired->report.welded_vertices, 55U);
    EXPECT_EQ(repaired->report.isolated_vertices, 1U);
    EXPECT_EQ(repaired->report.degenerate_faces, 1U);
    EXPECT_EQ(repaired->report.duplicate_faces, 2U);
    EXPECT_EQ(repaired->report.non_manifold_edges, 1U);
    // The tetrahedron's tip and both ends of the fin's edge.
    EXPECT_EQ(repaired->report.non_manifold_vertices, 3U);
    const auto inside_out = static_cast<std::uint32_t>(std::count_if(
        mesh.triangles.begin(),
        mesh.triangles.end(),
        [&](const Triangle& face) {
            return mesh.positions[face[0]][2] + mesh.positions[face[1]][2] +
                       mesh.positions[face[2]][2] <
                   -1.8;
        }
    ));
    EXPECT_GT(inside_out, 100U);
    EXPECT_EQ(repaired->report.flipped_faces, inside_out);
    EXPECT_EQ(repaired->components, 3U);      // starfish, fin, tetrahedron
    EXPECT_EQ(repaired->boundary_edges, 3U);  // those of the fin
    EXPECT_TRUE(precompute::check_manifold(repaired->mesh).has_value());
}

TEST(Models, FitTheRepository)
{
    std::uintmax_t total = 0;
    for (const Model& model : kModels)
    {
        const std::uintmax_t bytes = std::filesystem::file_size(path_of(model.name));
        EXPECT_LE(bytes, 400'000U) << model.name;
        total += bytes;
    }
    EXPECT_LE(total, 2'500'000U);
}

}  // namespace
}  // namespace vsplit::assets
