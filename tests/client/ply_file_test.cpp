#include "ply_file.h"

#include "core/file_io.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace vsplit::client {
namespace {

class PlyFile : public testing::Test
{
protected:
    ~PlyFile() override { std::filesystem::remove(path_); }

    // The file's header, and the bytes after it.
    std::pair<std::string, std::string> write(const SurfaceArrays& values)
    {
        IndexedMesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
        mesh.triangles = {{0, 1, 2}};
        EXPECT_TRUE(write_ply(path_, mesh, values).has_value());
        const auto bytes = read_file(path_);
        EXPECT_TRUE(bytes.has_value());
        const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        const std::size_t end = text.find("end_header\n") + 11;
        return {text.substr(0, end), text.substr(end)};
    }

    std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / ("saved" + std::to_string(::getpid()) + ".ply");
};

TEST_F(PlyFile, HoldsPositionsAndTrianglesOnlyWhenThereIsNothingElse)
{
    const auto [header, data] = write({});
    EXPECT_EQ(header.find("red"), std::string::npos);
    EXPECT_EQ(header.find("nx"), std::string::npos);
    EXPECT_EQ(data.size(), 3U * 24 + 13);
}

TEST_F(PlyFile, HoldsNormalsColorsAndTextureCoordinatesThatAreThere)
{
    SurfaceArrays values;
    values.positions.resize(3);
    values.normals.assign(3, {0, 0, 32767, 32767});
    values.colors.assign(3, {1, 2, 3, 4});
    values.tex_coords[0].assign(3, {0.25F, 0.25F});
    EXPECT_TRUE(has_ply_values(values));
    EXPECT_EQ(write(values).first.find("nx"), std::string::npos)
        << "derived ones are not the model's";
    values.authored_normals = true;
    const auto [header, data] = write(values);
    for (const char* name :
         {"float nx", "float nz", "uchar red", "uchar alpha", "float s", "float t"})
    {
        EXPECT_NE(header.find(std::string("property ") + name + "\n"), std::string::npos) << name;
    }
    ASSERT_EQ(data.size(), 3U * (24 + 12 + 4 + 8) + 13);
    float normal_z = 0.0F;
    std::memcpy(&normal_z, data.data() + 24 + 8, sizeof(normal_z));
    EXPECT_FLOAT_EQ(normal_z, 1.0F);
    EXPECT_EQ(data.substr(36, 4), std::string("\x01\x02\x03\x04"));
    float t = 0.0F;
    std::memcpy(&t, data.data() + 44, sizeof(t));
    EXPECT_FLOAT_EQ(t, 0.75F) << "PLY counts from below";
}

}  // namespace
}  // namespace vsplit::client
