#include "codec/mesh_digest.h"

#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <array>
#include <cstdio>

namespace vsplit::test {
namespace {

/// CRC-32C of a list's numbers, 32 bits each, little-endian.
template <typename List>
std::uint32_t checksum(const List& rows)
{
    ByteWriter bytes;
    for (const auto& row : rows)
    {
        for (const auto number : row)
        {
            bytes.write(static_cast<std::uint32_t>(number));
        }
    }
    return crc32c(bytes.view());
}

std::string hex(std::uint32_t number)
{
    std::array<char, 9> text{};
    std::snprintf(text.data(), text.size(), "%08lx", static_cast<unsigned long>(number));
    return text.data();
}

}  // namespace

std::string describe_level(std::uint32_t level, int shift, const GridMesh& mesh)
{
    return std::to_string(level) + ' ' + std::to_string(mesh.positions.size()) + ' ' +
           std::to_string(mesh.triangles.size()) + ' ' + std::to_string(shift) + ' ' +
           hex(checksum(mesh.positions)) + ' ' + hex(checksum(mesh.triangles)) + '\n';
}

std::string describe_stitches(std::span<const std::uint32_t> stitches)
{
    const std::array<std::span<const std::uint32_t>, 1> rows{stitches};
    return stitches.empty() ? std::string() : "stitches " + hex(checksum(rows)) + '\n';
}

}  // namespace vsplit::test
