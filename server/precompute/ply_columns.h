#pragma once

#include "mesh/surface.h"
#include "precompute/ply_header.h"
#include "precompute/source_model.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::precompute {

/// Where a scalar property of a vertex goes.
struct PlyColumn
{
    /// What it is part of.
    enum class Target : std::uint8_t
    {
        Skip,
        Position,
        Attribute,
    };

    Target target = Target::Skip;
    std::size_t attribute = 0;  ///< Index into PlyVertexPlan::attributes.
    std::size_t component = 0;  ///< Axis, or number within a value of the attribute.
    double scale = 1.0;         ///< Multiplies what the file has.
    double offset = 0.0;        ///< Is added then.
};

/// What the properties of the vertices mean.
struct PlyVertexPlan
{
    std::vector<PlyColumn> columns;            ///< One for each property.
    std::vector<SurfaceAttribute> attributes;  ///< Without values yet.
    bool has_position = false;                 ///< x, y and z are there.
};

/// Decides what to do with the properties of the vertices of a PLY file: x y z; nx ny nz; red green blue
/// and alpha; s t, u v or texture_u texture_v (v upwards in the file); other floating-point numbers as
/// they are. `dropped`: gets a note for every property that is not used. Cost: linear but for a few
/// dozen known names. Thread safe. Safe on untrusted input.
[[nodiscard]] PlyVertexPlan plan_ply_vertices(const PlyElement& element, DroppedNotes& dropped);

/// What a property of a face is for.
enum class PlyFaceUse : std::uint8_t
{
    Skip,
    Corners,
    TexCoords,  ///< Of every corner, u and v in turn.
};

/// Tells it by the name, as writers use it today. Thread safe.
[[nodiscard]] PlyFaceUse ply_face_use(const PlyProperty& property);

}  // namespace vsplit::precompute
