#include "image_files.h"
#include "mesh_files.h"
#include "precompute/surface_io.h"

#include <gmock/gmock.h>

namespace vsplit::precompute {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ObjModel : public test::MeshFiles
{
protected:
    [[nodiscard]] Result<SourceModel> model(std::string_view contents) const
    {
        return read_surface(save("model.obj", contents));
    }
};

constexpr std::string_view kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0.25\nvt 1 1\nvt 0 1\nvn 0 1 1\nvn 0 -1 1\n";

std::string square(std::string_view more)
{
    return std::string(kSquare) + std::string(more);
}

TEST_F(ObjModel, TakesCornersOfAPolygon)
{
    const auto read = model(square("f 1/1/1 2/2/1 3/-2/2 4/4/2\n"));
    ASSERT_TRUE(read) << describe(read.error());
    const auto& attributes = read->surface.attributes;
    ASSERT_THAT(attributes, SizeIs(2));
    EXPECT_EQ(attributes[0].kind, AttributeKind::TexCoord);
    EXPECT_THAT(attributes[0].values, ElementsAre(0, 1, 1, 0.75F, 1, 0, 0, 0));
    EXPECT_THAT(attributes[0].corners, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    EXPECT_EQ(attributes[1].kind, AttributeKind::Normal);
    EXPECT_THAT(attributes[1].corners, ElementsAre(Triangle{0, 0, 1}, Triangle{0, 1, 1}));
    EXPECT_THAT(read->dropped, IsEmpty());
    EXPECT_THAT(read->appearance.groups, IsEmpty());
    EXPECT_THAT(read->surface.groups, IsEmpty());
}

TEST_F(ObjModel, FillsCornersWithoutValues)
{
    const auto read = model(square("f 1 2 3\nf 1/1 3/9 4/4\n"));
    ASSERT_TRUE(read);
    ASSERT_THAT(read->surface.attributes, SizeIs(1));
    EXPECT_THAT(
        read->surface.attributes[0].corners, ElementsAre(Triangle{4, 4, 4}, Triangle{0, 4, 3})
    );
    EXPECT_THAT(read->dropped, Contains(HasSubstr("1 references")));
}

TEST_F(ObjModel, TakesColorsBehindCoordinates)
{
    const auto read = model("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_TRUE(read);
    ASSERT_THAT(read->surface.attributes, SizeIs(1));
    EXPECT_EQ(read->surface.attributes[0].kind, AttributeKind::Color);
    EXPECT_THAT(read->surface.attributes[0].values, ElementsAre(1, 0, 0, 0, 0.5F, 0, 1, 1, 1));
}

TEST_F(ObjModel, TakesGroupsAndMaterials)
{
    save("skin.png", test::tiny_png());
    save(
        "model.mtl",
        "newmtl skin\nKd 0.5 0.25 1\nNs 0\nmap_Kd -clamp on -s 1 1 1 skin.png\nmap_Ka skin.png\n"
        "newmtl glass\nd 0.5\nPr 0.1\nPm 0.75\nKe 1 0 0\nnorm skin.png\nnewmtl skin\nKd 0 0 0\n"
    );
    const auto read = model(
        square("mtllib model.mtl\no body\nusemtl skin\nf 1/1 2/2 3/3\nusemtl glass\nf 1/1 3/3 4/4\n"
               "usemtl skin\nf 1/1 2/2 4/4\n")
    );
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_THAT(read->appearance.groups, ElementsAre(FaceGroup{"body", 0}, FaceGroup{"body", 1}));
    EXPECT_THAT(read->surface.groups, ElementsAre(0, 1, 0));
    ASSERT_THAT(read->appearance.materials, SizeIs(2));
    const Material& skin = read->appearance.materials[0];
    EXPECT_EQ(skin.base_color, (std::array{0.5F, 0.25F, 1.0F, 1.0F}));
    EXPECT_EQ(skin.base_color_texture.wrap_u, TextureWrap::Clamp);
    EXPECT_EQ(skin.metallic, 0.0F);
    EXPECT_EQ(skin.roughness, 1.0F);
    const Material& glass = read->appearance.materials[1];
    EXPECT_EQ(glass.alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(glass.base_color[3], 0.5F);
    EXPECT_EQ(glass.roughness, 0.1F);
    EXPECT_EQ(glass.metallic, 0.75F);
    EXPECT_EQ(glass.normal_texture.image, 0);
    EXPECT_THAT(read->images, SizeIs(1)) << "each image once";
    EXPECT_THAT(read->dropped, Contains(HasSubstr("map_ka")));
    EXPECT_THAT(read->dropped, Contains(HasSubstr("scale and offset")));
}

TEST_F(ObjModel, ReadsNothingOutsideItsFolder)
{
    std::filesystem::create_directories(path("inner"));
    save("secret.png", test::tiny_png());
    std::filesystem::create_symlink(path("secret.png"), path("inner/link.png"));
    save(
        "inner/m.mtl",
        "newmtl a\nmap_Kd ../secret.png\nnewmtl b\nmap_Kd link.png\nnewmtl c\nmap_Kd " +
            path("secret.png").string() + "\n"
    );
    const auto read =
        read_surface(save("inner/model.obj", square("mtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\n")));
    ASSERT_TRUE(read);
    EXPECT_THAT(read->images, IsEmpty());
    EXPECT_THAT(read->dropped, SizeIs(3));
    EXPECT_THAT(read->dropped, ::testing::Each(HasSubstr("not in the folder")));
}

TEST_F(ObjModel, NotesWhatIsMissing)
{
    const auto read = model(square("mtllib none.mtl\nusemtl unknown\nf 1/1 2/2 3/3\nl 1 2\n"));
    ASSERT_TRUE(read);
    EXPECT_THAT(read->dropped, Contains(HasSubstr("none.mtl")));
    EXPECT_THAT(read->dropped, Contains(HasSubstr("lines")));
    ASSERT_THAT(read->appearance.materials, SizeIs(1));
    EXPECT_EQ(read->appearance.materials[0].name, "unknown");
}

TEST_F(ObjModel, TakesOffTexturesThatAreNoImages)
{
    save("model.mtl", "newmtl skin\nmap_Kd model.mtl\n");
    const auto read = model(square("mtllib model.mtl\nusemtl skin\nf 1/1 2/2 3/3\n"));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->appearance.materials[0].base_color_texture.image, -1);
    EXPECT_THAT(read->dropped, Contains(HasSubstr("no PNG or JPEG")));
}

}  // namespace
}  // namespace vsplit::precompute
