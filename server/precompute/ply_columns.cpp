// Based on: Turk, "The PLY Polygon File Format", 1994; names of normals, colours and texture coordinates
// as MeshLab, Blender and Open3D write them.
#include "precompute/ply_columns.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace vsplit::precompute {
namespace {

using Names = std::initializer_list<std::string_view>;

constexpr std::size_t kMaxScalars = 8;

/// Finds the scalar property of a name that nothing uses yet.
std::optional<std::size_t> find_property(
    const PlyElement& element, const PlyVertexPlan& plan, std::string_view name
)
{
    for (std::size_t i = 0; i < element.properties.size(); ++i)
    {
        const PlyProperty& property = element.properties[i];
        const bool free = plan.columns[i].target == PlyColumn::Target::Skip;
        if (free && !property.count_type && property.name == name)
        {
            return i;
        }
    }
    return std::nullopt;
}

/// Finds all properties of a list of names; nothing when one is missing.
std::optional<std::vector<std::size_t>> find_all(
    const PlyElement& element, const PlyVertexPlan& plan, Names names
)
{
    std::vector<std::size_t> found;
    for (const std::string_view name : names)
    {
        const auto property = find_property(element, plan, name);
        if (!property)
        {
            return std::nullopt;
        }
        found.push_back(*property);
    }
    return found;
}

/// What brings integers to 0 .. 1, as colours are stored.
double unit_scale(PlyType type)
{
    switch (type)
    {
        case PlyType::Uint8:
            return 1.0 / 255.0;
        case PlyType::Uint16:
            return 1.0 / 65535.0;
        case PlyType::Int8:
            return 1.0 / 127.0;
        case PlyType::Int16:
            return 1.0 / 32767.0;
        case PlyType::Int32:
        case PlyType::Uint32:
            return 1.0 / 255.0;
        case PlyType::Float32:
        case PlyType::Float64:
            break;
    }
    return 1.0;
}

class Planner
{
public:
    explicit Planner(const PlyElement& element) : element_(element)
    {
        plan_.columns.resize(element.properties.size());
    }

    PlyVertexPlan plan(DroppedNotes& dropped)
    {
        plan_.has_position = take_position();
        take(AttributeKind::Normal, {{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}});
        take(
            AttributeKind::Color,
            {{"red", "green", "blue", "alpha"},
             {"red", "green", "blue"},
             {"diffuse_red", "diffuse_green", "diffuse_blue"},
             {"r", "g", "b", "a"},
             {"r", "g", "b"}}
        );
        take(
            AttributeKind::TexCoord,
            {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}
        );
        take_scalars(dropped);
        return std::move(plan_);
    }

private:
    bool take_position()
    {
        const auto found = find_all(element_, plan_, {"x", "y", "z"});
        for (std::size_t axis = 0; found && axis < 3; ++axis)
        {
            plan_.columns[(*found)[axis]] = {PlyColumn::Target::Position, 0, axis, 1.0, 0.0};
        }
        return found.has_value();
    }

    /// Takes the first of several lists of names that is there completely.
    void take(AttributeKind kind, std::initializer_list<Names> choices)
    {
        for (const Names names : choices)
        {
            if (const auto found = find_all(element_, plan_, names))
            {
                add(kind, *found, "");
                return;
            }
        }
    }

    void add(AttributeKind kind, const std::vector<std::size_t>& properties, std::string name)
    {
        SurfaceAttribute attribute;
        attribute.kind = kind;
        attribute.components = static_cast<std::uint8_t>(properties.size());
        attribute.name = std::move(name);
        attribute.set = static_cast<std::uint8_t>(
            std::ranges::count(plan_.attributes, kind, &SurfaceAttribute::kind)
        );
        for (std::size_t i = 0; i < properties.size(); ++i)
        {
            PlyColumn& column = plan_.columns[properties[i]];
            column = {PlyColumn::Target::Attribute, plan_.attributes.size(), i, 1.0, 0.0};
            if (kind == AttributeKind::Color)
            {
                column.scale = unit_scale(element_.properties[properties[i]].type);
            }
            if (kind == AttributeKind::TexCoord && i == 1)
            {
                column.scale = -1.0;  // upwards there, downwards here
                column.offset = 1.0;
            }
        }
        plan_.attributes.push_back(std::move(attribute));
    }

    void take_scalars(DroppedNotes& dropped)
    {
        std::size_t scalars = 0;
        for (std::size_t i = 0; i < element_.properties.size(); ++i)
        {
            const PlyProperty& property = element_.properties[i];
            if (plan_.columns[i].target != PlyColumn::Target::Skip)
            {
                continue;
            }
            const bool real =
                property.type == PlyType::Float32 || property.type == PlyType::Float64;
            if (real && !property.count_type && scalars < kMaxScalars)
            {
                add(AttributeKind::Scalar, {i}, property.name);
                ++scalars;
                continue;
            }
            dropped.add("vertex property '" + property.name + "'");
        }
    }

    const PlyElement& element_;
    PlyVertexPlan plan_;
};

}  // namespace

PlyVertexPlan plan_ply_vertices(const PlyElement& element, DroppedNotes& dropped)
{
    return Planner(element).plan(dropped);
}

PlyFaceUse ply_face_use(const PlyProperty& property)
{
    if (!property.count_type)
    {
        return PlyFaceUse::Skip;
    }
    if (property.name == "vertex_indices" || property.name == "vertex_index")
    {
        return PlyFaceUse::Corners;
    }
    return property.name == "texcoord" ? PlyFaceUse::TexCoords : PlyFaceUse::Skip;
}

}  // namespace vsplit::precompute
