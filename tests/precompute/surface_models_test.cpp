#include "mesh_files.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"

#include <gmock/gmock.h>

#include <ostream>

namespace vsplit::precompute {
namespace {

/// What the list of the development meshes says of one of them.
struct Expected
{
    const char* file = "";
    std::size_t vertices = 0;    ///< In the file.
    std::size_t triangles = 0;   ///< In the file.
    std::size_t tex_coords = 0;  ///< In the file.
    std::size_t normals = 0;     ///< In the file.
    std::size_t colors = 0;      ///< Distinct ones.
    bool image = false;
};

void PrintTo(const Expected& expected, std::ostream* out)
{
    *out << expected.file;
}

class SurfaceModels : public ::testing::TestWithParam<Expected>
{
};

std::size_t value_count(const std::vector<SurfaceAttribute>& attributes, AttributeKind kind)
{
    for (const SurfaceAttribute& attribute : attributes)
    {
        if (attribute.kind == kind)
        {
            return attribute.size();
        }
    }
    return 0;
}

TEST_P(SurfaceModels, ComeInWithTheirAttributes)
{
    if (test::models_folder().empty())
    {
        GTEST_SKIP() << "no development meshes; set VSPLIT_MODELS";
    }
    const Expected& expected = GetParam();
    const auto model = read_surface(test::models_folder() / expected.file);
    ASSERT_TRUE(model) << describe(model.error());
    EXPECT_EQ(model->surface.mesh.positions.size(), expected.vertices);
    EXPECT_EQ(model->surface.mesh.triangles.size(), expected.triangles);
    const auto& attributes = model->surface.attributes;
    EXPECT_EQ(value_count(attributes, AttributeKind::TexCoord), expected.tex_coords);
    EXPECT_EQ(value_count(attributes, AttributeKind::Normal), expected.normals);
    EXPECT_EQ(model->images.size(), expected.image ? 1U : 0U);
    EXPECT_THAT(model->dropped, ::testing::IsEmpty());
    const auto repaired = repair_surface(model->surface);
    ASSERT_TRUE(repaired) << describe(repaired.error());
    EXPECT_EQ(value_count(repaired->attributes, AttributeKind::Color), expected.colors);
}

INSTANTIATE_TEST_SUITE_P(
    Folder,
    SurfaceModels,
    ::testing::Values(
        Expected{"spot.obj", 2930, 5856, 3225, 0, 0, true},
        Expected{"duck.obj", 2108, 4212, 2277, 2170, 0, true},
        Expected{"damaged-helmet.obj", 8661, 15452, 6553, 11141, 0, true},
        Expected{"fuze.obj", 502, 1000, 664, 502, 0, true},
        Expected{"african-head.obj", 1258, 2492, 1339, 1258, 0, true},
        Expected{"bunny10k-textured.obj", 5051, 9999, 6451, 0, 0, true},
        Expected{"textured-knot.obj", 1440, 2880, 1573, 0, 0, true},
        Expected{"gargo.ply", 25002, 50000, 0, 25002, 246, false},
        Expected{"swirl-color.ply", 9216, 18050, 0, 0, 1070, false},
        Expected{"airplane-color.ply", 7017, 10796, 0, 0, 1115, false},
        Expected{"horse.ply", 48485, 96966, 0, 48485, 0, false}
    )
);

}  // namespace
}  // namespace vsplit::precompute
