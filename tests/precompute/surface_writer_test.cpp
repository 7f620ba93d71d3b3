#include "core/file_io.h"
#include "image_files.h"
#include "mesh_files.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <sys/wait.h>

namespace vsplit::precompute {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Two triangles with a seam, hard and soft edges, colours, a scalar, two groups and a texture.
SourceModel sample()
{
    SourceModel model;
    model.surface.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
    model.surface.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    model.surface.attributes = {
        {AttributeKind::TexCoord,
         0,
         2,
         "",
         {0.1F, 0.2F, 0.7F, 0, 1, 0.9F, 0, 1, 0.3F, 0.3F},
         {{0, 1, 2}, {4, 2, 3}}},
        {AttributeKind::Normal, 0, 3, "", {1, 0, 0, 0, 1, 0, 0, 0, 1}, {{0, 0, 1}, {0, 2, 2}}},
        {AttributeKind::Color, 0, 4, "", {1, 0, 0, 1, 0, 0.2F, 0, 0.4F}, {{0, 0, 1}, {0, 1, 1}}},
        {AttributeKind::Scalar, 0, 1, "_heat", {1.5F, -2}, {{0, 0, 1}, {0, 1, 1}}}};
    model.surface.groups = {0, 1};
    Material skin;
    skin.name = "skin of all";
    skin.base_color = {0.5F, 0.25F, 1, 1};
    skin.metallic = 0;
    skin.roughness = 0.75F;
    skin.base_color_texture.image = 0;
    Material glass;
    glass.alpha_mode = AlphaMode::Blend;
    glass.base_color[3] = 0.5F;
    glass.emissive = {0, 0.5F, 0};
    model.appearance.materials = {skin, glass};
    model.appearance.groups = {{"body", 0}, {"window pane", 1}};
    model.appearance.images = {{"hide", 1, 1, 3}};
    const std::string png = test::tiny_png();
    const auto bytes = test::bytes_of(png);
    model.images = {{"hide", {bytes.begin(), bytes.end()}}};
    return model;
}

class SurfaceWriter : public test::MeshFiles
{
protected:
    [[nodiscard]] Result<SourceModel> round_trip(const SourceModel& model, std::string_view name)
        const
    {
        const auto written =
            write_surface(path(name), view_model(model.surface, model.appearance, model.images));
        return written ? read_surface(path(name))
                       : Result<SourceModel>(tl::unexpected<Error>(written.error()));
    }
};

/// The values of an attribute at every corner, one after the other.
std::vector<float> corner_values(const SurfaceAttribute& attribute)
{
    std::vector<float> values;
    for (const Triangle& corners : attribute.corners)
    {
        for (const std::uint32_t value : corners)
        {
            const auto begin =
                attribute.values.begin() + value * std::ptrdiff_t{attribute.components};
            values.insert(values.end(), begin, begin + attribute.components);
        }
    }
    return values;
}

std::vector<std::array<float, 3>> corner_points(const IndexedMesh& mesh)
{
    std::vector<std::array<float, 3>> points;
    for (const Triangle& triangle : mesh.triangles)
    {
        for (const std::uint32_t vertex : triangle)
        {
            const auto& [x, y, z] = mesh.positions[vertex];
            points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        }
    }
    return points;
}

void expect_same(const Surface& have, const Surface& want, float tolerance = 0.0F)
{
    EXPECT_EQ(corner_points(have.mesh), corner_points(want.mesh));
    ASSERT_EQ(have.attributes.size(), want.attributes.size());
    for (const SurfaceAttribute& wanted : want.attributes)
    {
        const auto found = std::ranges::find_if(have.attributes, [&](const auto& attribute) {
            return attribute.kind == wanted.kind && attribute.set == wanted.set;
        });
        ASSERT_NE(found, have.attributes.end());
        EXPECT_EQ(found->components, wanted.components);
        EXPECT_THAT(
            corner_values(*found),
            ::testing::Pointwise(::testing::FloatNear(tolerance), corner_values(wanted))
        );
    }
}

TEST_F(SurfaceWriter, BringsEverythingBackFromGlb)
{
    const SourceModel model = sample();
    const auto read = round_trip(model, "model.glb");
    ASSERT_TRUE(read) << describe(read.error());
    expect_same(read->surface, model.surface);
    EXPECT_EQ(read->surface.groups, model.surface.groups);
    EXPECT_EQ(read->appearance, model.appearance);
    ASSERT_THAT(read->images, SizeIs(1));
    EXPECT_EQ(read->images[0].bytes, model.images[0].bytes);
    EXPECT_EQ(read->surface.attributes.back().name, "_heat");
    EXPECT_THAT(read->dropped, IsEmpty());
}

TEST_F(SurfaceWriter, BringsBackFromObjWhatItCanHold)
{
    SourceModel model = sample();
    const auto read = round_trip(model, "model.obj");
    ASSERT_TRUE(read) << describe(read.error());
    model.surface.attributes.pop_back();  // no scalars
    model.surface.attributes[2] = {
        AttributeKind::Color, 0, 3, "", {1, 0, 0, 0, 0.2F, 0}, {{0, 0, 1}, {0, 1, 1}}};
    expect_same(read->surface, model.surface);
    EXPECT_EQ(read->surface.groups, model.surface.groups);
    EXPECT_EQ(read->appearance.groups, model.appearance.groups);
    ASSERT_THAT(read->appearance.materials, SizeIs(2));
    EXPECT_EQ(read->appearance.materials[0], model.appearance.materials[0]);
    EXPECT_EQ(read->appearance.materials[1].alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(read->appearance.materials[1].emissive[1], 0.5F);
    ASSERT_THAT(read->images, SizeIs(1));
    EXPECT_EQ(read->images[0].bytes, model.images[0].bytes);
    EXPECT_THAT(read->dropped, IsEmpty());
}

TEST_F(SurfaceWriter, BringsBackFromPlyWhatItCanHold)
{
    const SourceModel model = sample();
    const auto read = round_trip(model, "model.ply");
    ASSERT_TRUE(read) << describe(read.error());
    expect_same(read->surface, model.surface, 1e-7F);
    EXPECT_THAT(read->surface.mesh.positions, SizeIs(6)) << "split at the seam";
    EXPECT_THAT(read->images, SizeIs(1));
    EXPECT_THAT(read->dropped, IsEmpty());
}

/// Status of Khronos' validator: 0 when it finds nothing, 77 when it is not installed.
int validate(const std::filesystem::path& file)
{
    const std::string command =
        std::string(VSPLIT_SOURCE_DIR "/scripts/validate-gltf ") + file.string();
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(SurfaceWriter, WritesGlbThatTheValidatorOfKhronosAccepts)
{
    std::vector<SourceModel> models{sample()};
    models.push_back(sample());
    models.back().surface.attributes.clear();
    models.back().surface.groups.clear();
    models.back().appearance = {};
    models.push_back(sample());
    models.back().surface.attributes[0].set = 3;  // and no texture is on it
    for (const char* const name : {"duck.obj", "damaged-helmet.obj", "gargo.ply", "beetle.obj"})
    {
        if (auto model = read_surface(test::models_folder() / name))
        {
            models.push_back(std::move(*model));
        }
    }
    for (const SourceModel& model : models)
    {
        const auto file = path("model.glb");
        const auto view = view_model(model.surface, model.appearance, model.images);
        ASSERT_TRUE(write_surface(file, view));
        const int status = validate(file);
        if (status == 77 || status == 127)
        {
            GTEST_SKIP() << "no gltf-validator; scripts/validate-gltf says how to install it";
        }
        EXPECT_EQ(status, 0);
    }
}

TEST_F(SurfaceWriter, WritesTheSameBytesAgain)
{
    const SourceModel model = sample();
    const auto view = view_model(model.surface, model.appearance, model.images);
    for (const char* const name : {"a.glb", "a.ply", "a.obj"})
    {
        ASSERT_TRUE(write_surface(path(name), view));
        const auto first = read_file(path(name));
        ASSERT_TRUE(write_surface(path(name), view));
        EXPECT_EQ(first.value(), read_file(path(name)).value());
    }
}

TEST_F(SurfaceWriter, LeavesOutTexturesWithoutImages)
{
    SourceModel model = sample();
    model.images[0].bytes.clear();
    for (const char* const name : {"model.glb", "model.ply", "model.obj"})
    {
        const auto read = round_trip(model, name);
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_THAT(read->images, IsEmpty());
        EXPECT_THAT(read->dropped, IsEmpty());
    }
}

TEST_F(SurfaceWriter, RefusesAnEmptyGlbAndUnknownExtensions)
{
    const SourceModel empty;
    const auto view = view_model(empty.surface, empty.appearance, empty.images);
    EXPECT_EQ(write_surface(path("a.glb"), view).error().code, ErrorCode::EmptyMesh);
    EXPECT_EQ(write_surface(path("a.fbx"), view).error().code, ErrorCode::UnsupportedInput);
    EXPECT_FALSE(std::filesystem::exists(path("a.glb")));
}

TEST_F(SurfaceWriter, BringsRealModelsBackFromGlb)
{
    if (test::models_folder().empty())
    {
        GTEST_SKIP() << "no development meshes; set VSPLIT_MODELS";
    }
    for (const char* const name : {"duck.obj", "damaged-helmet.obj", "gargo.ply", "beetle.obj"})
    {
        const auto model = read_surface(test::models_folder() / name);
        ASSERT_TRUE(model) << describe(model.error());
        const auto repaired = repair_surface(model->surface);
        ASSERT_TRUE(repaired);
        SourceModel again = *model;
        again.surface = {repaired->repaired.mesh, repaired->attributes, repaired->groups};
        const auto read = round_trip(again, "model.glb");
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_EQ(read->surface.mesh.triangles.size(), again.surface.mesh.triangles.size()) << name;
        EXPECT_EQ(read->surface.attributes.size(), again.surface.attributes.size()) << name;
        expect_same(read->surface, again.surface, 2e-6F);
    }
}

}  // namespace
}  // namespace vsplit::precompute
