#include "make_assets/write_ply.h"

#include "core/byte_writer.h"
#include "core/file_io.h"

#include <bit>
#include <string>

namespace vsplit::assets {

Result<void> write_ply(const std::filesystem::path& path, const IndexedMesh& mesh)
{
    const bool is_small = mesh.positions.size() <= 0x10000U;
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment vsplit asset, MIT licence\nelement vertex " +
        std::to_string(mesh.positions.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(mesh.triangles.size()) + "\nproperty list uchar " +
        (is_small ? "ushort" : "int") + " vertex_indices\nend_header\n";
    ByteWriter writer;
    writer.write_bytes(std::as_bytes(std::span(header)));
    for (const auto& position : mesh.positions)
    {
        for (const double coordinate : position)
        {
            writer.write(std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
        }
    }
    for (const Triangle& triangle : mesh.triangles)
    {
        writer.write(std::uint8_t{3});
        for (const std::uint32_t vertex : triangle)
        {
            is_small ? writer.write(static_cast<std::uint16_t>(vertex)) : writer.write(vertex);
        }
    }
    return write_file_atomically(path, writer.view());
}

}  // namespace vsplit::assets
