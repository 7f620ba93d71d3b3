#include "codec/base_mesh_decoder.h"

#include "codec/base_mesh_tables.h"
#include "core/byte_reader.h"

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>

namespace vsplit::codec {
namespace {

constexpr std::size_t kDracoMagicBytes = 5;
constexpr std::size_t kMethodOffset = 8;
constexpr std::uint8_t kDracoMesh = 1;
constexpr std::uint8_t kDracoSequential = 0;
constexpr std::uint8_t kDracoEdgebreaker = 1;

tl::unexpected<Error> bad_base()
{
    return fail(ErrorCode::BadChunk, "the base mesh does not decode");
}

/// How Draco describes the one attribute of a base mesh: positions, three 32-bit integers, under number
/// 0, coded as integers.
constexpr std::array<std::uint8_t, 7> kPositions{
    1,
    draco::GeometryAttribute::POSITION,
    draco::DT_INT32,
    3,
    0,
    0,
    draco::SEQUENTIAL_ATTRIBUTE_ENCODER_INTEGER};

/// Compares the entropy coder's tables that are announced with the largest that our encoder makes.
bool fits(ByteReader& reader, const BaseMeshTables& tables)
{
    const auto prediction = static_cast<std::int8_t>(reader.read<std::uint8_t>().value_or(0));
    if (prediction != draco::PREDICTION_NONE && !reader.read<std::uint8_t>())
    {
        return false;
    }
    const auto compressed = reader.read<std::uint8_t>();
    if (!compressed || *compressed == 0)
    {
        return compressed.has_value();
    }
    constexpr std::uint32_t kTags = 32;
    const auto scheme = reader.read<std::uint8_t>();
    const bool tagged = scheme && *scheme == draco::SYMBOL_CODING_TAGGED;
    const auto symbol_bits = tagged ? Result<std::uint8_t>(0) : reader.read<std::uint8_t>();
    const auto symbols = reader.read_varint();
    return symbol_bits && symbols && *symbol_bits <= tables.symbol_bits &&
           *symbols <= (tagged ? kTags : tables.symbols);
}

/// One of Draco's mesh decoders, made to look at what is said of the attributes before it takes memory
/// for them: a few bytes could ask for any number of attributes of 2 kB a vertex, and for megabytes of
/// tables. `kGroupBytes`: bytes that the method uses to describe a group of attributes.
template <typename DracoDecoder, std::size_t kGroupBytes>
class PositionDecoder final : public DracoDecoder
{
public:
    explicit PositionDecoder(const BaseMeshTables& tables) : tables_(tables) {}

protected:
    bool DecodePointAttributes() override
    {
        const draco::DecoderBuffer& buffer = *this->buffer();
        ByteReader reader(std::as_bytes(
            std::span(buffer.data_head(), static_cast<std::size_t>(buffer.remaining_size()))
        ));
        const auto groups = reader.read<std::uint8_t>();
        const auto group = reader.read_bytes(kGroupBytes);
        const auto attribute = reader.read_bytes(kPositions.size());
        return groups && *groups == 1 && group && attribute &&
               std::ranges::equal(*attribute, std::as_bytes(std::span(kPositions))) &&
               fits(reader, tables_) && DracoDecoder::DecodePointAttributes();
    }

private:
    BaseMeshTables tables_;
};

/// A group belongs to attribute data, has a kind and a traversal.
using EdgebreakerDecoder = PositionDecoder<draco::MeshEdgebreakerDecoder, 3>;
using SequentialDecoder = PositionDecoder<draco::MeshSequentialDecoder, 0>;

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

Result<GridMesh> decode_draco_base(
    std::span<const std::byte> bytes,
    std::uint32_t vertices,
    std::uint32_t faces,
    std::uint32_t max_index
)
{
    VSPLIT_TRY(check_draco_counts(bytes, vertices, faces));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const draco::DecoderOptions options;
    draco::Mesh mesh;
    const bool edgebreaker = bytes[kMethodOffset] == std::byte{kDracoEdgebreaker};
    const auto tables = BaseMeshTables::of(vertices, max_index);
    const draco::Status status = edgebreaker
                                     ? EdgebreakerDecoder(tables).Decode(options, &buffer, &mesh)
                                     : SequentialDecoder(tables).Decode(options, &buffer, &mesh);
    if (!status.ok() || buffer.remaining_size() != 0)
    {
        return bad_base();
    }
    return copy_mesh(mesh, vertices, faces);
}

}  // namespace vsplit::codec
