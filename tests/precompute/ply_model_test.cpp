#include "image_files.h"
#include "mesh_files.h"
#include "precompute/surface_io.h"

#include <gmock/gmock.h>

#include <limits>

namespace vsplit::precompute {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class PlyModel : public test::MeshFiles
{
protected:
    [[nodiscard]] Result<SourceModel> model(std::string_view contents) const
    {
        return read_surface(save("model.ply", contents));
    }
};

constexpr std::string_view kColored =
    "ply\nformat ascii 1.0\nelement vertex 4\n"
    "property float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
    "property float s\nproperty float t\nproperty float quality\nproperty int flags\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0 2 255 0 0 255 0 0 0.5 1\n"
    "1 0 0 0 1 0 0 255 0 255 1 0 1.5 1\n"
    "1 1 0 1 0 0 0 0 255 255 1 1 2.5 1\n"
    "0 1 0 0 0 0 51 51 51 255 0 1 3.5 1\n"
    "3 0 1 2\n3 0 2 3\n";

TEST_F(PlyModel, TakesNormalsColorsCoordinatesAndScalars)
{
    const auto read = model(kColored);
    ASSERT_TRUE(read) << describe(read.error());
    const auto& attributes = read->surface.attributes;
    ASSERT_THAT(attributes, SizeIs(4));
    EXPECT_EQ(attributes[0].kind, AttributeKind::Normal);
    EXPECT_EQ(attributes[1].kind, AttributeKind::Color);
    EXPECT_EQ(attributes[2].kind, AttributeKind::TexCoord);
    EXPECT_EQ(attributes[3].kind, AttributeKind::Scalar);
    EXPECT_EQ(attributes[3].name, "quality");
    EXPECT_EQ(attributes[1].components, 3) << "alpha was 1 everywhere";
    EXPECT_FLOAT_EQ(attributes[1].values[9], 0.2F);
    EXPECT_THAT(attributes[1].corners, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    EXPECT_THAT(attributes[2].values, ElementsAre(0, 1, 1, 1, 1, 0, 0, 0)) << "v points downwards";
    EXPECT_THAT(read->dropped, ElementsAre("vertex property 'flags'"));
}

TEST_F(PlyModel, GivesNormalsALengthAndADirection)
{
    const auto read = model(kColored);
    ASSERT_TRUE(read);
    const SurfaceAttribute& normals = read->surface.attributes[0];
    EXPECT_FLOAT_EQ(normals.values[2], 1.0F);
    const std::uint32_t missing = normals.corners[1][2];
    EXPECT_FLOAT_EQ(normals.values[3 * missing + 2], 1.0F) << "the face's";
}

TEST_F(PlyModel, DropsNormalsThatAreThoseOfTheFaces)
{
    std::string flat(kColored);
    for (const std::string_view other : {" 0 1 0 ", " 1 0 0 "})
    {
        flat.replace(flat.find(std::string(other) + "0 "), other.size(), " 0 0 1 ");
    }
    const auto read = model(flat);
    ASSERT_TRUE(read);
    EXPECT_THAT(read->surface.attributes, SizeIs(3));
    EXPECT_THAT(read->dropped, ::testing::Contains(HasSubstr("flat faces")));
}

TEST_F(PlyModel, ZeroesWhatIsNotFiniteAndSaysSo)
{
    std::string bad(kColored);
    bad.replace(bad.find("2.5"), 3, "nan");
    const auto read = model(bad);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->surface.attributes[3].values[2], 0.0F);
    EXPECT_THAT(read->dropped, ::testing::Contains(HasSubstr("not finite")));
}

TEST_F(PlyModel, TakesCoordinatesOfCornersAndTheImageOfAComment)
{
    save("skin.png", test::tiny_png());
    const auto read = model(
        "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 0\n"
    );
    ASSERT_TRUE(read) << describe(read.error());
    ASSERT_THAT(read->surface.attributes, SizeIs(1));
    const SurfaceAttribute& coordinates = read->surface.attributes[0];
    EXPECT_THAT(coordinates.values, ElementsAre(0, 1, 1, 1, 1, 0, 0, 0));
    EXPECT_THAT(coordinates.corners, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 3, 3}));
    ASSERT_THAT(read->appearance.images, SizeIs(1));
    EXPECT_EQ(read->images[0].bytes.size(), test::tiny_png().size());
    EXPECT_EQ(read->appearance.materials.at(0).base_color_texture.image, 0);
}

TEST_F(PlyModel, TakesOffATextureThatIsMissing)
{
    std::string textured(kColored);
    textured.replace(0, 3, "ply\ncomment TextureFile ../secret.png");
    const auto read = model(textured);
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_THAT(read->appearance.materials, IsEmpty());
    EXPECT_THAT(read->dropped, ::testing::Contains(HasSubstr("not in the folder")));
}

TEST_F(PlyModel, RefusesEveryTruncationInsideTheRows)
{
    const std::string whole(kColored);
    const std::size_t body = whole.find("end_header");
    for (std::size_t size = body; size + 2 < whole.size(); ++size)
    {
        EXPECT_FALSE(model(whole.substr(0, size))) << size;
    }
}

}  // namespace
}  // namespace vsplit::precompute
