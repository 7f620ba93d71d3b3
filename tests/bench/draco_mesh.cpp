#include "draco_mesh.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <array>

namespace vsplit::bench {
namespace {

void copy_mesh(const IndexedMesh& mesh, draco::Mesh& result)
{
    const auto vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    result.SetNumFaces(mesh.triangles.size());
    result.set_num_points(vertex_count);
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    {
        const Triangle& triangle = mesh.triangles[f];
        result.SetFace(
            draco::FaceIndex(f),
            {draco::PointIndex(triangle[0]),
             draco::PointIndex(triangle[1]),
             draco::PointIndex(triangle[2])}
        );
    }
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int id = result.AddAttribute(attribute, true, vertex_count);
    for (std::uint32_t v = 0; v < vertex_count; ++v)
    {
        std::array<float, 3> position{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            position[k] = static_cast<float>(mesh.positions[v][k]);
        }
        result.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), position.data());
    }
}

tl::unexpected<Error> draco_failure(const draco::Status& status)
{
    return fail(ErrorCode::Internal, "Draco: " + status.error_msg_string());
}

}  // namespace

Result<std::vector<char>> encode_with_draco(const IndexedMesh& mesh, int bits)
{
    draco::Mesh input;
    copy_mesh(mesh, input);
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);  // what draco_encoder makes of -cl 10
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(input, &buffer);
    if (!status.ok())
    {
        return draco_failure(status);
    }
    return *buffer.buffer();
}

Result<std::unique_ptr<draco::Mesh>> decode_with_draco(std::span<const char> bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
    {
        return draco_failure(decoded.status());
    }
    return std::move(decoded).value();
}

IndexedMesh copy_out(const draco::Mesh& mesh)
{
    IndexedMesh result;
    const draco::PointAttribute& attribute =
        *mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    for (std::uint32_t p = 0; p < mesh.num_points(); ++p)
    {
        std::array<float, 3> position{};
        attribute.GetMappedValue(draco::PointIndex(p), position.data());
        result.positions.push_back({position[0], position[1], position[2]});
    }
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    {
        const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
        result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
    }
    return result;
}

}  // namespace vsplit::bench
