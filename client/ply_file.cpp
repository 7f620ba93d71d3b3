#include "ply_file.h"

#include "core/assert.h"
#include "core/byte_writer.h"
#include "core/file_io.h"

#include <bit>
#include <cstdint>
#include <span>
#include <string>

namespace vsplit::client {
namespace {

std::string header_of(const IndexedMesh& mesh, const SurfaceArrays& values)
{
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment written by vsplit-pda\nelement vertex " +
        std::to_string(mesh.positions.size()) +
        "\nproperty double x\nproperty double y\nproperty double z\n";
    if (values.authored_normals)
    {
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    }
    if (!values.colors.empty())
    {
        header +=
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar alpha\n";
    }
    if (!values.tex_coords[0].empty())
    {
        header += "property float s\nproperty float t\n";
    }
    return header + "element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

void write_float(ByteWriter& writer, float value)
{
    writer.write(std::bit_cast<std::uint32_t>(value));
}

void write_values(ByteWriter& writer, const SurfaceArrays& values, std::size_t vertex)
{
    if (values.authored_normals)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            write_float(writer, static_cast<float>(values.normals[vertex][axis]) / 32767.0F);
        }
    }
    if (!values.colors.empty())
    {
        for (const std::uint8_t channel : values.colors[vertex])
        {
            writer.write(channel);
        }
    }
    if (!values.tex_coords[0].empty())
    {
        write_float(writer, values.tex_coords[0][vertex][0]);
        write_float(writer, 1.0F - values.tex_coords[0][vertex][1]);
    }
}

}  // namespace

bool has_ply_values(const SurfaceArrays& values)
{
    return values.authored_normals || !values.colors.empty() || !values.tex_coords[0].empty();
}

Result<void> write_ply(
    const std::filesystem::path& path, const IndexedMesh& mesh, const SurfaceArrays& values
)
{
    VSPLIT_ASSERT(!has_ply_values(values) || values.positions.size() == mesh.positions.size());
    ByteWriter writer;
    const std::string header = header_of(mesh, values);
    writer.write_bytes(std::as_bytes(std::span(header)));
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
    {
        for (const double coordinate : mesh.positions[vertex])
        {
            writer.write_f64(coordinate);
        }
        write_values(writer, values, vertex);
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        writer.write<std::uint8_t>(3);
        for (const std::uint32_t vertex : triangle)
        {
            writer.write(vertex);
        }
    }
    return write_file_atomically(path, writer.view());
}

}  // namespace vsplit::client
