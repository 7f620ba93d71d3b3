#include "codec/mesh_digest.h"

#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <array>
#include <cstdio>
#include <type_traits>

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

std::string describe_attributes(const codec::LevelAttributes& attributes)
{
    const auto of = [](const auto& numbers) {
        const std::array<std::span<const typename std::decay_t<decltype(numbers)>::value_type>, 1>
            rows{numbers};
        return numbers.empty() ? std::string(" -") : ' ' + hex(checksum(rows));
    };
    std::string text = "attributes " + std::to_string(attributes.wedge_vertices.size()) +
                       of(attributes.wedge_vertices) + ' ' + hex(checksum(attributes.wedges)) +
                       of(attributes.groups);
    for (const auto& values : attributes.values)
    {
        text += of(values);
    }
    return text + '\n';
}

std::string describe_stitches(std::span<const std::uint32_t> stitches)
{
    const std::array<std::span<const std::uint32_t>, 1> rows{stitches};
    return stitches.empty() ? std::string() : "stitches " + hex(checksum(rows)) + '\n';
}

}  // namespace vsplit::test
