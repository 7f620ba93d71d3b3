#pragma once

#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vsplit {

/// What the values of an attribute mean.
enum class AttributeKind : std::uint8_t
{
    TexCoord = 0,  ///< Two components, the origin at the image's upper left corner, as glTF has it.
    Normal = 1,    ///< Three components, of length 1.
    Color = 2,   ///< Three or four components in 0 .. 1: red, green, blue and alpha, linear or not.
    Scalar = 3,  ///< One to four components of anything.
};

/// Values on a surface that may differ at the corners of the triangles around one vertex, where a seam
/// runs: a table of values, and for every corner of every triangle the one that it has.
struct SurfaceAttribute
{
    AttributeKind kind = AttributeKind::TexCoord;
    std::uint8_t set = 0;           ///< Number among the attributes of its kind, from 0.
    std::uint8_t components = 2;    ///< Numbers in a value, 1 .. 4.
    std::string name;               ///< What the source calls it; empty when the kind says all.
    std::vector<float> values;      ///< `components` numbers a value, all finite.
    std::vector<Triangle> corners;  ///< By triangle the values at its corners.

    /// Number of values.
    [[nodiscard]] std::size_t size() const { return values.size() / components; }

    /// Memberwise equality.
    friend bool operator==(const SurfaceAttribute&, const SurfaceAttribute&) = default;
};

/// A triangle mesh with what lies on it.
struct Surface
{
    IndexedMesh mesh;
    std::vector<SurfaceAttribute> attributes;
    std::vector<std::uint32_t> groups;  ///< By triangle, see Appearance::groups; empty: all in 0.
};

}  // namespace vsplit
