#include "glb_file.h"
#include "image_files.h"
#include "mesh_files.h"
#include "precompute/surface_io.h"

#include <gmock/gmock.h>

#include <cmath>
#include <initializer_list>

namespace vsplit::precompute {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// What a test changes in the document of square().
struct Square
{
    std::string asset = R"("asset":{"version":"2.0"})";
    std::string nodes = R"("scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}])";
    std::string mesh =
        R"("meshes":[{"name":"square","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,)"
        R"("TEXCOORD_0":2,"COLOR_0":3},"indices":4}]}])";
    std::string accessors =
        R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
        R"({"bufferView":1,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"},)"
        R"({"bufferView":2,"componentType":5123,"normalized":true,"count":4,"type":"VEC2"},)"
        R"({"bufferView":3,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"},)"
        R"({"bufferView":4,"componentType":5121,"count":6,"type":"SCALAR"})";
    std::string more = R"("materials":[])";
    std::string image;

    [[nodiscard]] std::string file() const
    {
        using test::packed;
        std::string buffer = packed<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        // Padded to four bytes each; slanted, so that they are not those of the faces.
        buffer += packed<std::int8_t>({127, 0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0, 127, 0, 0});
        buffer += packed<std::uint16_t>({0, 0, 65535, 0, 65535, 65535, 0, 65535});
        buffer +=
            packed<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 51, 51, 51, 255});
        buffer += packed<std::uint8_t>({0, 1, 2, 0, 2, 3, 0, 0});
        const std::size_t start = buffer.size();
        buffer += image;
        const std::string views = R"({"buffer":0,"byteOffset":0,"byteLength":48},)"
                                  R"({"buffer":0,"byteOffset":48,"byteLength":16,"byteStride":4},)"
                                  R"({"buffer":0,"byteOffset":64,"byteLength":16},)"
                                  R"({"buffer":0,"byteOffset":80,"byteLength":16},)"
                                  R"({"buffer":0,"byteOffset":96,"byteLength":6},)"
                                  R"({"buffer":0,"byteOffset":)" +
                                  std::to_string(start) + R"(,"byteLength":)" +
                                  std::to_string(image.size()) + "}";
        return test::glb_file(
            "{" + asset + "," + nodes + "," + mesh + R"(,"accessors":[)" + accessors +
                R"(],"bufferViews":[)" + views + R"(],"buffers":[{"byteLength":)" +
                std::to_string(buffer.size()) + "}]," + more + "}",
            buffer
        );
    }
};

class GltfModel : public test::MeshFiles
{
protected:
    [[nodiscard]] Result<SourceModel> model(const std::string& contents) const
    {
        return read_surface(save("model.glb", contents));
    }

    [[nodiscard]] ErrorCode code_of(const std::string& contents) const
    {
        const auto read = model(contents);
        return read ? ErrorCode::Ok : read.error().code;
    }
};

TEST_F(GltfModel, TakesAttributesOfAllComponentTypes)
{
    const auto read = model(Square{}.file());
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_THAT(read->surface.mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    const auto& attributes = read->surface.attributes;
    ASSERT_THAT(attributes, SizeIs(3));
    EXPECT_EQ(attributes[0].kind, AttributeKind::TexCoord);
    EXPECT_THAT(attributes[0].values, ElementsAre(0, 0, 1, 0, 1, 1, 0, 1));
    EXPECT_EQ(attributes[1].kind, AttributeKind::Normal);
    EXPECT_THAT(attributes[1].values, ElementsAre(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0));
    EXPECT_EQ(attributes[2].kind, AttributeKind::Color);
    EXPECT_EQ(attributes[2].components, 3);
    EXPECT_THAT(attributes[2].values[9], FloatEq(0.2F));
    EXPECT_THAT(read->appearance.groups, ElementsAre(FaceGroup{"square", -1}));
    EXPECT_THAT(read->dropped, IsEmpty());
}

TEST_F(GltfModel, AppliesTransformationsAndTurnsMirroredTriangles)
{
    Square square;
    square.nodes =
        R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1,2],"translation":[10,0,0]},)"
        R"({"mesh":0,"scale":[-2,1,1]},{"mesh":0,"rotation":[0,0,0.70710678,0.70710678]}])";
    const auto read = model(square.file());
    ASSERT_TRUE(read) << describe(read.error());
    const auto& mesh = read->surface.mesh;
    ASSERT_THAT(mesh.positions, SizeIs(8));
    EXPECT_THAT(mesh.positions[1], ElementsAre(8, 0, 0));
    EXPECT_NEAR(mesh.positions[5][1], 1.0, 1e-6) << "x became y";
    EXPECT_THAT(mesh.triangles[0], ElementsAre(0, 2, 1));
    EXPECT_THAT(mesh.triangles[2], ElementsAre(4, 5, 6));
    const SurfaceAttribute& normals = read->surface.attributes[1];
    EXPECT_THAT(normals.corners[0], ElementsAre(0, 2, 1));
    EXPECT_FLOAT_EQ(normals.values[0], -1.0F);
    EXPECT_NEAR(normals.values[13], 1.0F, 1e-6F);
}

TEST_F(GltfModel, KeepsNormalsUprightUnderScales)
{
    Square square;
    square.nodes = R"("nodes":[{"mesh":0,"matrix":[1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]}])";
    const auto read = model(square.file());
    ASSERT_TRUE(read);
    const SurfaceAttribute& normals = read->surface.attributes[1];
    EXPECT_NEAR(normals.values[0], std::sqrt(0.5F), 1e-6F);
    EXPECT_NEAR(normals.values[1], -std::sqrt(0.5F), 1e-6F) << "a shear moves x normals against y";
}

TEST_F(GltfModel, AssemblesStripsAndFans)
{
    for (const auto& [mode, last] :
         {std::pair(5, Triangle{1, 3, 2}), std::pair(6, Triangle{2, 3, 0})})
    {
        Square square;
        square.mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":)" +
                      std::to_string(mode) + "}]}]";
        const auto read = model(square.file());
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_THAT(read->surface.mesh.triangles, SizeIs(2));
        EXPECT_EQ(read->surface.mesh.triangles[1], last);
    }
}

TEST_F(GltfModel, TakesMaterialsAndImages)
{
    Square square;
    square.image = test::tiny_png();
    square.mesh.replace(square.mesh.find(R"("indices")"), 0, R"("material":1,)");
    square.more =
        R"("materials":[{"name":"unused"},{"name":"skin","doubleSided":true,"alphaMode":"MASK",)"
        R"("alphaCutoff":0.25,"emissiveFactor":[0,1,0],"pbrMetallicRoughness":{"metallicFactor":0.5,)"
        R"("baseColorTexture":{"index":0}}}],"textures":[{"source":0,"sampler":0}],)"
        R"("samplers":[{"wrapS":33071,"wrapT":33648}],)"
        R"("images":[{"bufferView":5,"mimeType":"image/png","name":"hide"}])";
    const auto read = model(square.file());
    ASSERT_TRUE(read) << describe(read.error());
    ASSERT_THAT(read->appearance.materials, SizeIs(1));
    const Material& material = read->appearance.materials[0];
    EXPECT_EQ(material.name, "skin");
    EXPECT_TRUE(material.double_sided);
    EXPECT_EQ(material.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(material.alpha_cutoff, 0.25F);
    EXPECT_EQ(material.metallic, 0.5F);
    EXPECT_EQ(material.base_color_texture.image, 0);
    EXPECT_EQ(material.base_color_texture.wrap_u, TextureWrap::Clamp);
    EXPECT_EQ(material.base_color_texture.wrap_v, TextureWrap::Mirror);
    ASSERT_THAT(read->images, SizeIs(1));
    EXPECT_EQ(read->images[0].name, "hide");
    EXPECT_EQ(read->images[0].bytes.size(), square.image.size());
    EXPECT_EQ(read->appearance.images[0].width, 1U);
}

TEST_F(GltfModel, BakesTextureTransformations)
{
    Square square;
    square.image = test::tiny_png();
    square.mesh.replace(square.mesh.find(R"("indices")"), 0, R"("material":0,)");
    square.more =
        R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
        R"({"KHR_texture_transform":{"offset":[0.5,0.25],"scale":[2,4]}}}}}],)"
        R"("textures":[{"source":0}],"images":[{"bufferView":5,"mimeType":"image/png"}],)"
        R"("extensionsUsed":["KHR_texture_transform"])";
    const auto read = model(square.file());
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_THAT(
        read->surface.attributes[0].values,
        ElementsAre(0.5F, 0.25F, 2.5F, 0.25F, 2.5F, 4.25F, 0.5F, 4.25F)
    );
    EXPECT_THAT(read->dropped, IsEmpty());
}

TEST_F(GltfModel, AppliesSparseAccessors)
{
    Square square;
    square.accessors.replace(
        square.accessors.find(R"("type":"VEC3"})"),
        14,
        R"("type":"VEC3","sparse":{"count":1,"indices":{"bufferView":4,"byteOffset":2,)"
        R"("componentType":5121},"values":{"bufferView":0,"byteOffset":12}}})"
    );
    const auto read = model(square.file());
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_THAT(read->surface.mesh.positions[2], ElementsAre(1, 0, 0));
}

TEST_F(GltfModel, NotesWhatHasNoPlace)
{
    Square square;
    square.nodes =
        R"("nodes":[{"mesh":0,"skin":0},{"camera":0}],"cameras":[{"type":"perspective",)"
        R"("perspective":{"yfov":1,"znear":1}}],"skins":[{"joints":[1]}],"animations":[{"channels":[)"
        R"({"sampler":0,"target":{"path":"scale","node":0}}],"samplers":[{"input":0,"output":0}]}])";
    square.mesh.replace(
        square.mesh.find(R"("COLOR_0")"),
        9,
        R"("TANGENT":3,"JOINTS_0":3,"_HEAT":4,"ODD":3,"COLOR_0")"
    );
    square.mesh.replace(square.mesh.find(R"("indices")"), 0, R"("targets":[{"POSITION":0}],)");
    square.more = R"("extensionsUsed":["KHR_lights_punctual"])";
    const auto read = model(square.file());
    ASSERT_TRUE(read) << describe(read.error());
    for (const char* const word :
         {"skins",
          "cameras",
          "animations",
          "morph",
          "tangents",
          "joints",
          "_HEAT",
          "ODD",
          "lights"})
    {
        EXPECT_THAT(read->dropped, Contains(HasSubstr(word)));
    }
}

TEST_F(GltfModel, RefusesAccessorsThatLeaveTheirBuffers)
{
    const auto with = [](std::string_view part, std::string_view other) {
        std::string file = Square{}.file();
        const std::size_t at = file.find(part);
        EXPECT_NE(at, file.npos);
        EXPECT_EQ(part.size(), other.size());
        return file.replace(at, part.size(), other);
    };
    EXPECT_EQ(code_of(with(R"("count":4)", R"("count":5)")), ErrorCode::NotAMesh);
    EXPECT_EQ(code_of(with(R"("byteLength":48)", R"("byteLength":99)")), ErrorCode::Ok);
    EXPECT_EQ(code_of(with(R"("byteOffset":96)", R"("byteOffset":99)")), ErrorCode::NotAMesh);
    EXPECT_EQ(code_of(with(R"("byteStride":4)", R"("byteStride":8)")), ErrorCode::NotAMesh);
    EXPECT_EQ(code_of(with(R"("bufferView":0)", R"("bufferView":9)")), ErrorCode::NotAMesh);
    EXPECT_EQ(code_of(with(R"("POSITION":0)", R"("POSITION":7)")), ErrorCode::NotAMesh);
    std::string file = Square{}.file();
    file[file.size() - 8] = 9;
    EXPECT_EQ(code_of(file), ErrorCode::BadIndex);
}

TEST_F(GltfModel, RefusesHugeClaims)
{
    Square square;
    square.accessors.replace(0, 57, R"({"componentType":5126,"count":4000000000)");
    EXPECT_EQ(code_of(square.file()), ErrorCode::NotAMesh);
    square = {};
    square.more = R"("extras":)" + std::string(5000, '[') + std::string(5000, ']');
    EXPECT_EQ(code_of(square.file()), ErrorCode::InputTooLarge);
}

TEST_F(GltfModel, RefusesNodesThatAreNoTree)
{
    Square square;
    square.nodes = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"children":[0]}])";
    EXPECT_EQ(code_of(square.file()), ErrorCode::NotAMesh);
    square.nodes = R"("scenes":[{"nodes":[7]}],"nodes":[{"mesh":0}])";
    EXPECT_EQ(code_of(square.file()), ErrorCode::NotAMesh);
}

TEST_F(GltfModel, RefusesUnknownCompression)
{
    Square square;
    square.more = R"("extensionsRequired":["EXT_meshopt_compression"])";
    EXPECT_EQ(code_of(square.file()), ErrorCode::UnsupportedInput);
}

TEST_F(GltfModel, RefusesEveryTruncation)
{
    const std::string file = Square{}.file();
    for (std::size_t size = 0; size < file.size(); size += 7)
    {
        EXPECT_FALSE(model(file.substr(0, size))) << size;
    }
}

TEST_F(GltfModel, ReadsBuffersOfItsFolderOnly)
{
    const std::string document =
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":)"
        R"({"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
        R"("type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
        R"("buffers":[{"byteLength":36,"uri":"NAME"}]})";
    const auto with = [&](std::string_view name) {
        std::string text = document;
        return text.replace(text.find("NAME"), 4, name);
    };
    std::filesystem::create_directories(path("inner/deep"));
    const std::string bytes = test::packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    save("outside.bin", bytes);
    save("inner/deep/in side.bin", bytes);
    const auto good = read_surface(save("inner/a.gltf", with("deep/in%20side.bin")));
    ASSERT_TRUE(good) << describe(good.error());
    EXPECT_TRUE(read_mesh(path("inner/a.gltf")));
    for (const std::string& name :
         {std::string("../outside.bin"),
          path("outside.bin").string(),
          std::string("%2e%2e/outside.bin")})
    {
        EXPECT_FALSE(read_surface(save("inner/b.gltf", with(name)))) << name;
    }
}

}  // namespace
}  // namespace vsplit::precompute
