#include "glb_file.h"
#include "mesh_files.h"
#include "precompute/surface_io.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>

#include <algorithm>

namespace vsplit::precompute {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Two triangles with positions, normals and texture coordinates. `speed`: 10 makes it sequential; `texture_type`:
/// of the texture coordinates, numbers or booleans.
std::string compressed_square(int speed, draco::DataType texture_type = draco::DT_FLOAT32)
{
    constexpr std::array<std::array<float, 3>, 4> kPoints{
        {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}}};
    constexpr std::array<std::array<float, 3>, 4> kNormals{
        {{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 0.0F}}};
    constexpr std::array<std::array<std::uint8_t, 2>, 4> kBooleans{
        {{0, 1}, {188, 1}, {2, 255}, {1, 0}}};
    constexpr std::array<std::array<int, 3>, 2> kFaces{{{0, 1, 2}, {0, 2, 3}}};
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int points =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int normals =
        builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const int texture = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, texture_type);
    for (int face = 0; face < 2; ++face)
    {
        const auto& [a, b, c] = kFaces[static_cast<std::size_t>(face)];
        const auto set = [&](int id, const auto& table) {
            builder.SetAttributeValuesForFace(
                id,
                draco::FaceIndex(static_cast<std::uint32_t>(face)),
                table[a].data(),
                table[b].data(),
                table[c].data()
            );
        };
        set(points, kPoints);
        set(normals, kNormals);
        if (texture_type == draco::DT_BOOL)
        {
            set(texture, kBooleans);
        }
        else
        {
            set(texture, kPoints);
        }
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetSpeedOptions(speed, speed);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

std::string draco_file(const std::string& bytes)
{
    const std::string size = std::to_string(bytes.size());
    return test::glb_file(
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"extensionsUsed":["KHR_draco_mesh_compression"],)"
        R"("extensionsRequired":["KHR_draco_mesh_compression"],"meshes":[{"primitives":[{"indices":3,)"
        R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"extensions":)"
        R"({"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0,"NORMAL":1,)"
        R"("TEXCOORD_0":2}}}}]}],"accessors":[{"componentType":5126,"count":4,"type":"VEC3"},)"
        R"({"componentType":5126,"count":4,"type":"VEC3"},{"componentType":5126,"count":4,"type":"VEC2"},)"
        R"({"componentType":5125,"count":6,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":)" +
            size + R"(}],"buffers":[{"byteLength":)" + size + "}]}",
        bytes
    );
}

class GltfDraco : public test::MeshFiles
{
};

TEST_F(GltfDraco, DecodesBothMethods)
{
    for (const int speed : {0, 10})
    {
        const auto read = read_surface(save("model.glb", draco_file(compressed_square(speed))));
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_THAT(read->surface.mesh.positions, SizeIs(4));
        EXPECT_THAT(read->surface.mesh.triangles, SizeIs(2));
        ASSERT_THAT(read->surface.attributes, SizeIs(2));
        const SurfaceAttribute& tex_coords = read->surface.attributes[0];
        const Triangle& corners = tex_coords.corners[0];
        const Triangle& triangle = read->surface.mesh.triangles[0];
        for (std::size_t i = 0; i < 3; ++i)
        {
            // The same numbers, each of them rounded by Draco.
            const auto& point = read->surface.mesh.positions[triangle[i]];
            EXPECT_NEAR(tex_coords.values[2 * corners[i]], point[0], 1e-3);
            EXPECT_NEAR(tex_coords.values[2 * corners[i] + 1], point[1], 1e-3);
        }
    }
}

TEST_F(GltfDraco, DropsAttributesOfAKindThatGltfDoesNotKnow)
{
    const auto file = draco_file(compressed_square(10, draco::DT_BOOL));
    const auto read = read_surface(save("model.glb", file));
    ASSERT_TRUE(read) << describe(read.error());
    ASSERT_THAT(read->surface.attributes, SizeIs(1));
    EXPECT_EQ(read->surface.attributes[0].kind, AttributeKind::Normal);
    EXPECT_THAT(read->dropped, Contains(HasSubstr("TEXCOORD_0")));
}

TEST_F(GltfDraco, RefusesEveryTruncation)
{
    for (const int speed : {0, 10})
    {
        const std::string whole = compressed_square(speed);
        for (std::size_t size = 1; size < whole.size(); ++size)
        {
            const auto read = read_surface(save("model.glb", draco_file(whole.substr(0, size))));
            EXPECT_FALSE(read) << size;
        }
    }
}

TEST_F(GltfDraco, RefusesHugeClaims)
{
    std::string bytes = compressed_square(10);
    bytes.replace(11, 1, std::string("\xFF\xFF\xFF\x7F", 4));  // faces
    EXPECT_FALSE(read_surface(save("model.glb", draco_file(bytes))));
}

}  // namespace
}  // namespace vsplit::precompute
