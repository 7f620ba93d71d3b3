#include "draco_surface.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace vsplit::bench {
namespace {

draco::GeometryAttribute::Type draco_type(AttributeKind kind)
{
    switch (kind)
    {
        case AttributeKind::TexCoord:
            return draco::GeometryAttribute::TEX_COORD;
        case AttributeKind::Normal:
            return draco::GeometryAttribute::NORMAL;
        case AttributeKind::Color:
            return draco::GeometryAttribute::COLOR;
        case AttributeKind::Scalar:
            break;
    }
    return draco::GeometryAttribute::GENERIC;
}

/// An attribute with every value once: what Draco's own readers make.
SurfaceAttribute without_repetition(const SurfaceAttribute& attribute)
{
    SurfaceAttribute result = attribute;
    result.values.clear();
    std::map<std::vector<float>, std::uint32_t> places;
    std::vector<std::uint32_t> place_of(attribute.size(), ~0U);
    for (Triangle& triangle : result.corners)
    {
        for (std::uint32_t& corner : triangle)
        {
            std::uint32_t& place = place_of[corner];
            if (place == ~0U)
            {
                const auto first = attribute.values.begin() + corner * attribute.components;
                const std::vector<float> value(first, first + attribute.components);
                const auto next = static_cast<std::uint32_t>(places.size());
                const auto [entry, is_new] = places.try_emplace(value, next);
                place = entry->second;
                if (is_new)
                {
                    result.values.insert(result.values.end(), value.begin(), value.end());
                }
            }
            corner = place;
        }
    }
    return result;
}

/// Gives the mesh one point for every combination of indices that a corner has.
/// Result: by point its indices, the vertex first.
std::vector<std::vector<std::uint32_t>> make_points(
    const Surface& surface, const std::vector<SurfaceAttribute>& attributes, draco::Mesh& mesh
)
{
    std::vector<std::vector<std::uint32_t>> points;
    std::map<std::vector<std::uint32_t>, std::uint32_t> known;
    mesh.SetNumFaces(surface.mesh.triangles.size());
    for (std::uint32_t f = 0; f < surface.mesh.triangles.size(); ++f)
    {
        draco::Mesh::Face face;
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            std::vector<std::uint32_t> point{surface.mesh.triangles[f][corner]};
            for (const SurfaceAttribute& attribute : attributes)
            {
                point.push_back(attribute.corners[f][corner]);
            }
            const auto next = static_cast<std::uint32_t>(points.size());
            const auto [entry, is_new] = known.try_emplace(point, next);
            face[static_cast<int>(corner)] = draco::PointIndex(entry->second);
            if (is_new)
            {
                points.push_back(std::move(point));
            }
        }
        mesh.SetFace(draco::FaceIndex(f), face);
    }
    mesh.set_num_points(static_cast<std::uint32_t>(points.size()));
    return points;
}

/// Adds an attribute whose value at a point is the one that index `place` of the point names.
int add_attribute(
    draco::Mesh& mesh,
    const draco::GeometryAttribute& kind,
    std::size_t count,
    const std::vector<std::vector<std::uint32_t>>& points,
    std::size_t place
)
{
    const int id = mesh.AddAttribute(kind, false, static_cast<std::uint32_t>(count));
    draco::PointAttribute* const attribute = mesh.attribute(id);
    attribute->SetExplicitMapping(points.size());
    for (std::uint32_t p = 0; p < points.size(); ++p)
    {
        attribute->SetPointMapEntry(
            draco::PointIndex(p), draco::AttributeValueIndex(points[p][place])
        );
    }
    return id;
}

void add_positions(
    const IndexedMesh& source,
    const std::vector<std::vector<std::uint32_t>>& points,
    draco::Mesh& mesh
)
{
    draco::GeometryAttribute kind;
    kind.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int id = add_attribute(mesh, kind, source.positions.size(), points, 0);
    for (std::uint32_t v = 0; v < source.positions.size(); ++v)
    {
        std::array<float, 3> position{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            position[k] = static_cast<float>(source.positions[v][k]);
        }
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), position.data());
    }
}

void add_values(
    const SurfaceAttribute& source,
    const std::vector<std::vector<std::uint32_t>>& points,
    std::size_t place,
    draco::Mesh& mesh
)
{
    const bool bytes = source.kind == AttributeKind::Color;
    const std::size_t width = source.components;
    const auto stride = static_cast<std::int64_t>(bytes ? width : width * sizeof(float));
    draco::GeometryAttribute kind;
    kind.Init(
        draco_type(source.kind),
        nullptr,
        static_cast<std::uint8_t>(width),
        bytes ? draco::DT_UINT8 : draco::DT_FLOAT32,
        bytes,
        stride,
        0
    );
    const int id = add_attribute(mesh, kind, source.size(), points, place);
    for (std::uint32_t i = 0; i < source.size(); ++i)
    {
        const float* const value = &source.values[i * width];
        std::array<std::uint8_t, 4> rounded{};
        for (std::size_t k = 0; bytes && k < width; ++k)
        {
            rounded[k] = static_cast<std::uint8_t>(std::lround(value[k] * 255.0F));
        }
        const void* const data = bytes ? static_cast<const void*>(rounded.data()) : value;
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), data);
    }
}

AttributeKind kind_of(draco::GeometryAttribute::Type type)
{
    switch (type)
    {
        case draco::GeometryAttribute::TEX_COORD:
            return AttributeKind::TexCoord;
        case draco::GeometryAttribute::NORMAL:
            return AttributeKind::Normal;
        case draco::GeometryAttribute::COLOR:
            return AttributeKind::Color;
        default:
            return AttributeKind::Scalar;
    }
}

std::vector<Triangle> copy_corners(const draco::Mesh& mesh, const draco::PointAttribute& attribute)
{
    std::vector<Triangle> corners(mesh.num_faces());
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    {
        for (int k = 0; k < 3; ++k)
        {
            const draco::PointIndex point = mesh.face(draco::FaceIndex(f))[k];
            corners[f][static_cast<std::size_t>(k)] = attribute.mapped_index(point).value();
        }
    }
    return corners;
}

std::vector<float> copy_values(const draco::PointAttribute& attribute)
{
    const std::size_t width = attribute.num_components();
    std::vector<float> values(attribute.size() * width);
    for (std::uint32_t i = 0; i < attribute.size(); ++i)
    {
        // Normalised integers become 0 .. 1.
        attribute.ConvertValue<float>(
            draco::AttributeValueIndex(i), static_cast<std::int8_t>(width), &values[i * width]
        );
    }
    return values;
}

}  // namespace

Result<std::vector<char>> encode_surface_with_draco(const Surface& surface, const DracoBits& bits)
{
    std::vector<SurfaceAttribute> attributes;
    for (const SurfaceAttribute& attribute : surface.attributes)
    {
        attributes.push_back(without_repetition(attribute));
    }
    draco::Mesh mesh;
    const auto points = make_points(surface, attributes, mesh);
    add_positions(surface.mesh, points, mesh);
    for (std::size_t a = 0; a < attributes.size(); ++a)
    {
        add_values(attributes[a], points, a + 1, mesh);
    }
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);  // what draco_encoder makes of -cl 10
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits.position);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, bits.tex_coord);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, bits.normal);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::GENERIC, bits.generic);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
    if (!status.ok())
    {
        return fail(ErrorCode::Internal, "Draco: " + status.error_msg_string());
    }
    return *buffer.buffer();
}

Result<Surface> decode_surface_with_draco(std::span<const char> bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
    {
        return fail(ErrorCode::Internal, "Draco: " + decoded.status().error_msg_string());
    }
    const draco::Mesh& mesh = *decoded.value();
    Surface surface;
    for (int a = 0; a < mesh.num_attributes(); ++a)
    {
        const draco::PointAttribute& attribute = *mesh.attribute(a);
        auto corners = copy_corners(mesh, attribute);
        auto values = copy_values(attribute);
        if (attribute.attribute_type() == draco::GeometryAttribute::POSITION)
        {
            surface.mesh.triangles = std::move(corners);
            for (std::size_t i = 0; i < values.size(); i += 3)
            {
                surface.mesh.positions.push_back({values[i], values[i + 1], values[i + 2]});
            }
            continue;
        }
        SurfaceAttribute& copy = surface.attributes.emplace_back();
        copy.kind = kind_of(attribute.attribute_type());
        copy.components = static_cast<std::uint8_t>(attribute.num_components());
        copy.corners = std::move(corners);
        copy.values = std::move(values);
    }
    return surface;
}

}  // namespace vsplit::bench
