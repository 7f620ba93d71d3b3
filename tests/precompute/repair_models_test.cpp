// Repairs the development meshes; what is wrong with each was counted by another program.
#include "precompute/mesh_files.h"
#include "precompute/repair.h"
#include "precompute/validate.h"

namespace vsplit::test {
namespace {

using precompute::read_mesh;
using precompute::repair_mesh;
using precompute::RepairedMesh;

RepairedMesh repaired_model(const std::string& name)
{
    const auto mesh = read_mesh(models_folder() / name);
    EXPECT_TRUE(mesh) << mesh.error().message;
    auto result = repair_mesh(*mesh);
    EXPECT_TRUE(result) << result.error().message;
    return std::move(*result);
}

class RepairModels : public ::testing::Test
{
protected:
    void SetUp() override
    {
        if (model_files().empty())
        {
            GTEST_SKIP() << "no development meshes; set VSPLIT_MODELS";
        }
    }
};

TEST_F(RepairModels, MakesAManifoldOfEveryDevelopmentMesh)
{
    for (const auto& file : model_files())
    {
        const auto mesh = read_mesh(file);
        ASSERT_TRUE(mesh) << mesh.error().message;
        const auto result = repair_mesh(*mesh);
        ASSERT_TRUE(result) << file << ": " << result.error().message;
        const auto valid = precompute::check_manifold(result->mesh);
        EXPECT_TRUE(valid) << file << ": " << valid.error().message;
        const auto& report = result->report;
        EXPECT_EQ(
            result->mesh.positions.size() + report.welded_vertices + report.isolated_vertices,
            mesh->positions.size() + report.added_vertices
        );
        EXPECT_EQ(
            result->mesh.triangles.size() + report.degenerate_faces + report.duplicate_faces,
            mesh->triangles.size()
        );
    }
}

TEST_F(RepairModels, LeavesCleanMeshesAlone)
{
    for (const std::string name : {"homer.ply", "fandisk.ply", "dragon-100k.ply", "bones.ply"})
    {
        const RepairedMesh result = repaired_model(name);
        EXPECT_TRUE(result.report.clean()) << name;
        EXPECT_EQ(result.boundary_edges, 0U) << name;
        EXPECT_EQ(result.components, name == "bones.ply" ? 26U : 1U) << name;
    }
}

TEST_F(RepairModels, ReportsKnownDefects)
{
    const auto bunny = repaired_model("stanford-bunny.ply");
    EXPECT_EQ(bunny.report.isolated_vertices, 1113U);
    EXPECT_EQ(bunny.boundary_edges, 223U);

    const auto horizons = repaired_model("horizons.ply");
    EXPECT_EQ(horizons.components, 2U);
    EXPECT_EQ(horizons.boundary_edges, 160U);

    const auto cow = repaired_model("cow-2903.ply");
    EXPECT_EQ(cow.report.non_manifold_vertices, 1U);
    EXPECT_EQ(cow.report.added_vertices, 1U);

    const auto dragon = repaired_model("dragon-res3-nonmanifold.ply");
    EXPECT_EQ(dragon.report.isolated_vertices, 16U);
    EXPECT_EQ(dragon.report.duplicate_faces, 1254U);

    const auto chair = repaired_model("office-chair.ply");
    EXPECT_EQ(chair.report.welded_vertices, 2U);
    EXPECT_GE(chair.report.degenerate_faces, 16U);

    const auto moebius = repaired_model("moebius.ply");
    EXPECT_EQ(moebius.report.non_manifold_edges, 4U);
    EXPECT_EQ(moebius.report.flipped_faces, 0U);
    EXPECT_EQ(moebius.components, 1U);

    const auto beetle = repaired_model("beetle.obj");
    EXPECT_EQ(beetle.report.non_manifold_edges, 47U);
}

}  // namespace
}  // namespace vsplit::test
