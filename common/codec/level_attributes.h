#pragma once

#include "mesh/indexed_mesh.h"
#include "mesh/surface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vsplit::codec {

/// Most bits of a coded number.
inline constexpr std::uint8_t kMaxAttributeBits = 16;

/// What the header tells of an attribute. Normals are coded as two numbers, see write_values().
struct AttributeInfo
{
    AttributeKind kind = AttributeKind::TexCoord;
    std::uint8_t set = 0;         ///< Number among the attributes of its kind.
    std::uint8_t components = 2;  ///< Of a value: 2 texture coordinates, 3 normals, 1 .. 4 others.
    std::uint8_t bits = 10;       ///< Of a coded number, 1 .. 16.
    /// Colours only: coded as red, green and blue, not as brightness and two differences.
    bool rgb = false;
    std::string name{};
    std::array<float, 4> origin{};  ///< By component the value of 0; not used by normals.
    float cell = 1.0F;              ///< Step of a value, > 0; not used by normals.
};

/// Attributes of the level being shown. Corners of the triangles around a vertex that have the same
/// values form a *wedge*; a vertex has one wedge or, where seams run, several. Wedges keep their number
/// as the mesh gets finer, new ones are appended. A mesh for a GPU has one vertex a wedge.
struct LevelAttributes
{
    std::vector<std::uint32_t> wedge_vertices;  ///< By wedge its vertex.
    std::vector<Triangle> wedges;               ///< By slot the wedges at the triangle's corners.
    std::vector<std::uint32_t> groups;          ///< By slot; empty: all 0. See Appearance::groups.
    /// By attribute and wedge the coded numbers: AttributeInfo::components of them, two for normals.
    /// Empty as long as the attribute has no values: authored normals come with the last level.
    std::vector<std::vector<std::int32_t>> values;
};

/// Numbers that a value of an attribute is coded in.
[[nodiscard]] inline std::size_t coded_components(const AttributeInfo& info)
{
    return info.kind == AttributeKind::Normal ? 2 : info.components;
}

/// Tells whether attributes like this one can be coded: kind, components and bits fit each other.
[[nodiscard]] bool is_valid(const AttributeInfo& info);

/// Tells whether an attribute has an origin and a cell of its own; colours and normals have not.
[[nodiscard]] inline bool has_grid(const AttributeInfo& info)
{
    return info.kind == AttributeKind::TexCoord || info.kind == AttributeKind::Scalar;
}

/// Turns coded numbers into values: `components` floats for every value; normals are unit vectors.
/// `coded`: coded_components() numbers a value; `out`: components numbers a value, as many.
void write_values(
    const AttributeInfo& info, std::span<const std::int32_t> coded, std::span<float> out
);

}  // namespace vsplit::codec
