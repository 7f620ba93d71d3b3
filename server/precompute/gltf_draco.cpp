// Based on: Khronos, "KHR_draco_mesh_compression", 2018; Google, "Draco Bitstream Specification", 2.2,
// 2018 (which counts stand where).
#include "core/byte_reader.h"
#include "precompute/gltf_document.h"
#include "precompute/gltf_primitive.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr std::uint8_t kMesh = 1;
constexpr std::uint8_t kSequential = 0;
constexpr std::uint8_t kEdgebreaker = 1;
constexpr std::uint16_t kMetadata = 0x8000;

tl::unexpected<Error> bad_draco()
{
    return fail(ErrorCode::NotAMesh, "a mesh that Draco compressed does not decode");
}

/// Compares the counts at the head of a Draco stream with its size: Draco allocates for them first. A
/// connectivity of many triangles takes a small part of a bit each, hence the wide bound.
bool has_plausible_counts(std::span<const std::byte> bytes)
{
    constexpr std::uint64_t kFewestCounts = 4096;
    constexpr std::uint64_t kCountsPerByte = 256;
    ByteReader reader(bytes);
    const auto magic = reader.read_bytes(5);
    const auto version = reader.read<std::uint16_t>();
    const auto type = reader.read<std::uint8_t>();
    const auto method = reader.read<std::uint8_t>();
    const auto flags = reader.read<std::uint16_t>();
    // Metadata stand before the counts and are of no use here.
    if (!magic || !version || !type || !method || !flags || *version != 0x0202 || *type != kMesh ||
        (*flags & kMetadata) != 0 || *method > kEdgebreaker)
    {
        return false;
    }
    if (*method == kEdgebreaker && !reader.read<std::uint8_t>())
    {
        return false;
    }
    const auto first = reader.read_varint();
    const auto second = reader.read_varint();
    static_assert(kSequential == 0);
    const std::uint64_t most = kFewestCounts + kCountsPerByte * bytes.size();
    return first && second && *first <= most && *second <= most;
}

std::unique_ptr<draco::Mesh> decode(std::span<const std::byte> bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    return mesh.ok() ? std::move(mesh).value() : nullptr;
}

/// Tells whether an attribute has components of a kind that glTF knows. Draco knows more; its booleans may be
/// any byte, which no program may read as one.
bool has_known_components(const draco::PointAttribute& attribute)
{
    switch (attribute.data_type())
    {
        case draco::DT_INT8:
        case draco::DT_UINT8:
        case draco::DT_INT16:
        case draco::DT_UINT16:
        case draco::DT_UINT32:
        case draco::DT_FLOAT32:
            return attribute.num_components() >= 1 && attribute.num_components() <= 4;
        default:
            return false;
    }
}

AccessorValues copy_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute)
{
    AccessorValues result;
    result.components = static_cast<std::size_t>(attribute.num_components());
    result.values.reserve(mesh.num_points() * result.components);
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point)
    {
        std::array<float, 4> value{};
        const draco::AttributeValueIndex index = attribute.mapped_index(point);
        if (index.value() < attribute.size())
        {
            attribute.ConvertValue<float>(index, attribute.num_components(), value.data());
        }
        result.values.insert(
            result.values.end(), value.begin(), value.begin() + attribute.num_components()
        );
    }
    return result;
}

/// Divides by what the accessor of the attribute says when its integers are normalised; Draco's own
/// conversion does so only when its stream says it, too.
void normalise(
    const tinygltf::Model& model,
    const tinygltf::Primitive& primitive,
    const std::string& name,
    const draco::PointAttribute& attribute,
    AccessorValues& values
)
{
    const auto entry = primitive.attributes.find(name);
    const bool known = entry != primitive.attributes.end() && entry->second >= 0 &&
                       static_cast<std::size_t>(entry->second) < model.accessors.size();
    if (!known || attribute.normalized() ||
        !model.accessors[static_cast<std::size_t>(entry->second)].normalized)
    {
        return;
    }
    float largest = 0.0F;
    switch (attribute.data_type())
    {
        case draco::DT_INT8:
            largest = 127.0F;
            break;
        case draco::DT_UINT8:
            largest = 255.0F;
            break;
        case draco::DT_INT16:
            largest = 32767.0F;
            break;
        case draco::DT_UINT16:
            largest = 65535.0F;
            break;
        default:
            return;
    }
    for (float& value : values.values)
    {
        value = std::max(value / largest, -1.0F);
    }
}

}  // namespace

Result<GltfPrimitive> decode_draco_primitive(
    const tinygltf::Model& model,
    const tinygltf::Primitive& primitive,
    const tinygltf::Value& extension,
    DroppedNotes& dropped
)
{
    if (!extension.IsObject() || !extension.Get("bufferView").IsInt() ||
        !extension.Get("attributes").IsObject())
    {
        return bad_draco();
    }
    const auto bytes = view_bytes(model, extension.Get("bufferView").GetNumberAsInt());
    if (!bytes || !has_plausible_counts(*bytes))
    {
        return bad_draco();
    }
    const auto mesh = decode(*bytes);
    if (mesh == nullptr)
    {
        return bad_draco();
    }
    GltfPrimitive result;
    for (const std::string& name : extension.Get("attributes").Keys())
    {
        const tinygltf::Value& id = extension.Get("attributes").Get(name);
        const draco::PointAttribute* const attribute =
            id.IsInt() && id.GetNumberAsInt() >= 0
                ? mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id.GetNumberAsInt()))
                : nullptr;
        if (attribute == nullptr || !has_known_components(*attribute))
        {
            dropped.add("attribute '" + name + "', which Draco does not have as glTF knows it");
            continue;
        }
        const bool unused =
            name == "TANGENT" || name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
        if (unused)
        {
            dropped.add("attribute '" + name + "'");
            continue;
        }
        AccessorValues values = copy_attribute(*mesh, *attribute);
        normalise(model, primitive, name, *attribute, values);
        (name == "POSITION" ? result.positions : result.attributes[name]) = std::move(values);
    }
    result.triangles.reserve(mesh->num_faces());
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
    {
        const auto& corners = mesh->face(face);
        result.triangles.push_back({corners[0].value(), corners[1].value(), corners[2].value()});
    }
    return result;
}

}  // namespace vsplit::precompute
