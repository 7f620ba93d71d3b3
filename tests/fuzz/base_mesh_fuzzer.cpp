// Decodes hostile base meshes. The first four bytes are the counts that the index would promise, two
// bytes each; if both are zero, those that the Draco stream itself begins with, so that more gets
// through the first check. The top bit of the second count chooses the codec for small meshes.

#include "codec/base_mesh_decoder.h"
#include "codec/refinement_mesh.h"
#include "core/byte_reader.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace {

using namespace vsplit;

constexpr std::uint64_t kMostVertices = 4096;
constexpr std::int32_t kMostIndex = (1 << 16) - 1;
constexpr std::array<std::int32_t, 3> kExtent{63, 40, 21};
constexpr unsigned kSmallCodec = 0x8000;

void require(bool holds)
{
    if (!holds)
    {
        std::abort();
    }
}

struct Counts
{
    std::uint32_t vertices = 0;
    std::uint32_t faces = 0;
};

/// Counts at the head of an edgebreaker or sequential stream.
Counts own_counts(std::span<const std::byte> bytes)
{
    constexpr std::size_t kHeaderBytes = 11;
    constexpr std::size_t kMethodByte = 8;
    if (bytes.size() < kHeaderBytes + 1)
    {
        return {};
    }
    const bool edgebreaker = bytes[kMethodByte] == std::byte{1};
    ByteReader reader(bytes.subspan(kHeaderBytes + (edgebreaker ? 1 : 0)));
    const auto first = reader.read_varint().value_or(0);
    const auto second = reader.read_varint().value_or(0);
    const auto low = [](std::uint64_t count) {
        return static_cast<std::uint32_t>(std::min(count, 2 * kMostVertices));
    };
    return edgebreaker ? Counts{low(first), low(second)} : Counts{low(second), low(first)};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    ByteReader reader(std::as_bytes(std::span(data, size)));
    const auto vertices = reader.read<std::uint16_t>();
    const auto faces = reader.read<std::uint16_t>();
    if (!vertices || !faces)
    {
        return 0;
    }
    const auto bytes = *reader.read_bytes(reader.remaining());
    const bool small = (*faces & kSmallCodec) != 0;
    Counts counts{*vertices, static_cast<std::uint32_t>(*faces & ~kSmallCodec)};
    if (counts.vertices == 0 && counts.faces == 0)
    {
        counts = own_counts(bytes);
    }
    if (counts.vertices > kMostVertices || counts.faces > 2 * kMostVertices)
    {
        return 0;
    }
    const auto mesh =
        small ? codec::decode_small_base(bytes, counts.vertices, counts.faces, kExtent)
              : codec::decode_draco_base(bytes, counts.vertices, counts.faces, kMostIndex);
    if (!mesh)
    {
        require(mesh.error().code == ErrorCode::BadChunk);
        return 0;
    }
    require(mesh->positions.size() == counts.vertices && mesh->triangles.size() == counts.faces);
    codec::RefinementMesh refinement;
    refinement.reserve(counts.vertices, counts.faces);
    const auto done = refinement.set_base(*mesh, kMostIndex);
    require(done.has_value() || (refinement.vertex_count() == 0 && refinement.face_count() == 0));
    return 0;
}
