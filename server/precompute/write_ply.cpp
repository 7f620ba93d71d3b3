// Based on: Turk, "The PLY Polygon File Format", 1994; names of properties as MeshLab and Blender read
// them.
#include "precompute/model_writers.h"
#include "precompute/wedge_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vsplit::precompute {
namespace {

/// A letter that a property name may have.
bool is_plain(char letter)
{
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= '0' && letter <= '9') || letter == '_';
}

std::string property_name(const SurfaceAttribute& attribute)
{
    std::string name = attribute.name.empty() ? "scalar" : attribute.name;
    std::replace_if(
        name.begin(), name.end(), [](char letter) { return !is_plain(letter); }, '_'
    );
    return name;
}

/// True when colours are whole 255ths.
bool is_bytes(const SurfaceAttribute& colors)
{
    return std::ranges::all_of(colors.values, [](float value) {
        constexpr float kSmall = 1e-4F;
        const float scaled = value * 255.0F;
        return scaled >= 0.0F && scaled <= 255.5F && std::abs(scaled - std::round(scaled)) < kSmall;
    });
}

/// The attributes that a PLY file can hold, as it wants them.
std::vector<const SurfaceAttribute*> chosen(const ModelView& model)
{
    std::vector<const SurfaceAttribute*> result;
    for (const AttributeKind kind :
         {AttributeKind::Normal, AttributeKind::Color, AttributeKind::TexCoord})
    {
        if (const SurfaceAttribute* const attribute = first_of(model, kind))
        {
            result.push_back(attribute);
        }
    }
    for (const SurfaceAttribute& attribute : model.attributes)
    {
        if (attribute.kind == AttributeKind::Scalar && attribute.components == 1)
        {
            result.push_back(&attribute);
        }
    }
    return result;
}

void append_properties(std::string& header, const SurfaceAttribute& attribute)
{
    const auto add = [&](const char* type, const std::string& name) {
        header += std::string("property ") + type + " " + name + "\n";
    };
    switch (attribute.kind)
    {
        case AttributeKind::Normal:
            add("float", "nx");
            add("float", "ny");
            add("float", "nz");
            break;
        case AttributeKind::Color:
            for (const char* const name : {"red", "green", "blue"})
            {
                add(is_bytes(attribute) ? "uchar" : "float", name);
            }
            if (attribute.components == 4)
            {
                add(is_bytes(attribute) ? "uchar" : "float", "alpha");
            }
            break;
        case AttributeKind::TexCoord:
            add("float", "s");
            add("float", "t");
            break;
        case AttributeKind::Scalar:
            add("float", property_name(attribute));
            break;
    }
}

void append_value(
    ByteWriter& out, const SurfaceAttribute& attribute, bool bytes, std::uint32_t value
)
{
    for (std::size_t i = 0; i < attribute.components; ++i)
    {
        const float number = attribute.values[value * attribute.components + i];
        if (bytes)
        {
            out.write(static_cast<std::uint8_t>(std::lround(number * 255.0F)));
            continue;
        }
        const bool upwards = attribute.kind == AttributeKind::TexCoord && i == 1;
        append_float(out, upwards ? 1.0 - number : number);
    }
}

/// The image of the first material that has one.
std::int32_t base_image(const ModelView& model)
{
    if (model.appearance == nullptr || first_of(model, AttributeKind::TexCoord) == nullptr)
    {
        return -1;
    }
    for (const Material& material : model.appearance->materials)
    {
        if (material.base_color_texture.image >= 0)
        {
            return material.base_color_texture.image;
        }
    }
    return -1;
}

void append_body(
    ByteWriter& out,
    const ModelView& model,
    const WedgeMesh& wedges,
    const std::vector<const SurfaceAttribute*>& attributes
)
{
    std::vector<std::uint8_t> bytes;
    for (const SurfaceAttribute* const attribute : attributes)
    {
        bytes.push_back(attribute->kind == AttributeKind::Color && is_bytes(*attribute) ? 1 : 0);
    }
    for (std::size_t wedge = 0; wedge < wedges.vertices.size(); ++wedge)
    {
        for (const double coordinate : model.mesh.positions[wedges.vertices[wedge]])
        {
            append_float(out, coordinate);
        }
        for (std::size_t i = 0; i < attributes.size(); ++i)
        {
            const std::uint32_t value = wedges.values[wedge * attributes.size() + i];
            append_value(out, *attributes[i], bytes[i] != 0, value);
        }
    }
    for (const Triangle& triangle : wedges.triangles)
    {
        out.write(std::uint8_t{3});
        for (const std::uint32_t wedge : triangle)
        {
            out.write(wedge);
        }
    }
}

/// Without attributes the vertices stay as they are, also those that no triangle has.
WedgeMesh wedges_of(const ModelView& model, const std::vector<const SurfaceAttribute*>& attributes)
{
    WedgeMesh wedges;
    if (attributes.empty())
    {
        wedges.vertices.resize(model.mesh.positions.size());
        std::iota(wedges.vertices.begin(), wedges.vertices.end(), std::uint32_t{0});
        wedges.triangles = model.mesh.triangles;
        return wedges;
    }
    std::vector<std::uint32_t> faces(model.mesh.triangles.size());
    std::iota(faces.begin(), faces.end(), std::uint32_t{0});
    return split_wedges(model.mesh.triangles, attributes, faces, model.mesh.positions.size());
}

}  // namespace

WrittenFiles format_ply(const ModelView& model, const std::string& stem)
{
    const std::vector<const SurfaceAttribute*> attributes = chosen(model);
    const WedgeMesh wedges = wedges_of(model, attributes);
    const std::int32_t image = base_image(model);
    const std::string texture = image_file_name(model, image, stem);
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment written by vsplit\n";
    header += texture.empty() ? "" : "comment TextureFile " + texture + "\n";
    header += "element vertex " + std::to_string(wedges.vertices.size()) +
              "\nproperty float x\nproperty float y\nproperty float z\n";
    for (const SurfaceAttribute* const attribute : attributes)
    {
        append_properties(header, *attribute);
    }
    header += "element face " + std::to_string(wedges.triangles.size()) +
              "\nproperty list uchar int vertex_indices\nend_header\n";
    ByteWriter out;
    append_text(out, header);
    append_body(out, model, wedges, attributes);
    WrittenFiles files;
    files.push_back({"", out.take()});
    if (!texture.empty())
    {
        files.push_back({texture, model.images[static_cast<std::size_t>(image)].bytes});
    }
    return files;
}

}  // namespace vsplit::precompute
