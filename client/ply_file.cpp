#include "ply_file.h"

#include "core/byte_writer.h"
#include "core/file_io.h"

#include <span>
#include <string>

namespace vsplit::client {

Result<void> write_ply(const std::filesystem::path& path, const IndexedMesh& mesh)
{
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment written by vsplit-pda\nelement vertex " +
        std::to_string(mesh.positions.size()) +
        "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
        std::to_string(mesh.triangles.size()) +
        "\nproperty list uchar int vertex_indices\nend_header\n";
    ByteWriter writer;
    writer.write_bytes(std::as_bytes(std::span(header)));
    for (const auto& position : mesh.positions)
    {
        for (const double coordinate : position)
        {
            writer.write_f64(coordinate);
        }
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
