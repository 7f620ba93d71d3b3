#include "codec/base_mesh_decoder.h"

#include "core/byte_reader.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <memory>
#include <utility>

namespace vsplit::codec {
namespace {

constexpr std::size_t kDracoMagicBytes = 5;
constexpr std::uint8_t kDracoMesh = 1;
constexpr std::uint8_t kDracoSequential = 0;
constexpr std::uint8_t kDracoEdgebreaker = 1;

tl::unexpected<Error> bad_base()
{
    return fail(ErrorCode::BadChunk, "the base mesh does not decode");
}

/// Reads the counts at the head of a Draco mesh stream, version 2.2, and compares them, because Draco
/// allocates for them before it finds out that the data are too short.
Result<void> check_draco_counts(
    std::span<const std::byte> bytes, std::uint32_t vertices, std::uint32_t faces
)
{
    ByteReader reader(bytes);
    const auto magic = reader.read_bytes(kDracoMagicBytes);
    const auto version = reader.read<std::uint16_t>();
    const auto type = reader.read<std::uint8_t>();
    const auto method = reader.read<std::uint8_t>();
    const auto flags = reader.read<std::uint16_t>();
    if (!magic || !version || !type || !method || !flags || *version != 0x0202 ||
        *type != kDracoMesh || *flags != 0)
    {
        return bad_base();
    }
    std::uint64_t face_count = 0;
    if (*method == kDracoEdgebreaker)
    {
        const auto traversal = reader.read<std::uint8_t>();
        const auto encoded_vertices = reader.read_varint();
        const auto encoded_faces = reader.read_varint();
        const auto attribute_data = reader.read<std::uint8_t>();
        const auto symbols = reader.read_varint();
        const auto split_symbols = reader.read_varint();
        if (!traversal || !encoded_vertices || !encoded_faces || !attribute_data || !symbols ||
            !split_symbols || *attribute_data != 0 || *symbols > *encoded_faces ||
            *split_symbols > *symbols ||
            *encoded_vertices > std::uint64_t{vertices} + *split_symbols)
        {
            return bad_base();
        }
        face_count = *encoded_faces;
    }
    else if (*method == kDracoSequential)
    {
        const auto encoded_faces = reader.read_varint();
        const auto points = reader.read_varint();
        if (!encoded_faces || !points || *points != vertices)
        {
            return bad_base();
        }
        face_count = *encoded_faces;
    }
    return face_count == faces ? Result<void>{} : bad_base();
}

Result<GridMesh> copy_mesh(const draco::Mesh& mesh, std::uint32_t vertices, std::uint32_t faces)
{
    const draco::PointAttribute* const attribute =
        mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (attribute == nullptr || mesh.num_points() != vertices || mesh.num_faces() != faces ||
        attribute->num_components() != 3 || attribute->data_type() != draco::DT_INT32 ||
        attribute->byte_stride() != 12)
    {
        return bad_base();
    }
    GridMesh result;
    result.positions.resize(vertices);
    for (std::uint32_t v = 0; v < vertices; ++v)
    {
        const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(v));
        if (value.value() >= attribute->size())
        {
            return bad_base();
        }
        attribute->GetValue(value, &result.positions[v]);
    }
    result.triangles.resize(faces);
    for (std::uint32_t f = 0; f < faces; ++f)
    {
        const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
        result.triangles[f] = {face[0].value(), face[1].value(), face[2].value()};
    }
    return result;
}

}  // namespace

Result<GridMesh> decode_base_mesh(
    std::span<const std::byte> bytes, std::uint32_t vertices, std::uint32_t faces
)
{
    VSPLIT_TRY(check_draco_counts(bytes, vertices, faces));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok() || buffer.remaining_size() != 0)
    {
        return bad_base();
    }
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    return copy_mesh(*mesh, vertices, faces);
}

}  // namespace vsplit::codec
