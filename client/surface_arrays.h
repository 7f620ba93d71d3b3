#pragma once

#include "codec/level_attributes.h"
#include "mesh/indexed_mesh.h"
#include "mesh/surface.h"
#include "scene/appearance.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::client {

/// Triangles that are drawn at once: neighbours in the index array that have one material.
struct DrawRange
{
    std::int32_t material = -1;     ///< Index into Appearance::materials; -1: none.
    std::uint32_t first = 0;        ///< First triangle.
    std::uint32_t count = 0;        ///< Triangles.
    std::array<float, 3> centre{};  ///< Mean of the corners, for sorting what one sees through.

    /// Memberwise equality.
    friend bool operator==(const DrawRange&, const DrawRange&) = default;
};

/// Vertex and index arrays of a level with attributes, as the GPU takes them: one vertex a wedge.
struct SurfaceArrays
{
    std::vector<std::array<float, 3>> positions;  ///< Model units.
    /// Direction times flatness times 32767: 1 where the triangles around are flat or the normal is the
    /// author's. The fourth is 32767.
    std::vector<std::array<std::int16_t, 4>> normals;
    std::vector<std::array<std::uint8_t, 4>>
        colors;  ///< Set 0, 0 .. 255; empty when there are none.
    /// Sets 0 and 1, each empty when there is none.
    std::array<std::vector<std::array<float, 2>>, 2> tex_coords;
    std::vector<Triangle> triangles;  ///< In the order of `ranges`.
    std::vector<DrawRange> ranges;    ///< Opaque ones first; of the others one per group.
    bool authored_normals = false;    ///< The normals came with the model.

    /// Memory of the arrays, bytes.
    [[nodiscard]] std::uint64_t bytes() const;
};

/// What arrays are made of.
struct SurfaceInput
{
    std::span<const std::array<float, 3>> positions;     ///< By vertex, model units.
    std::span<const Triangle> triangles;                 ///< By slot, vertices.
    std::span<const codec::AttributeInfo> infos;         ///< Of the attributes; may be empty.
    const codec::LevelAttributes* attributes = nullptr;  ///< Fitting `triangles`; null: none.
    const Appearance* appearance = nullptr;              ///< Null: no materials.
};

/// Makes the arrays of a level. Where there are no authored normals they are derived per wedge if the
/// model has some coming, so that hard edges stay hard, and per vertex if not; wedges that lie on a
/// smooth surface share one, so that a seam of the texture is not seen in the light.
/// Preconditions: attributes and triangles refer to each other's vertices and wedges as
/// codec::LevelAttributes says. Cost: linear. Thread safe.
/// Source of the normals: gpu_buffers.cpp.
[[nodiscard]] SurfaceArrays make_surface_arrays(const SurfaceInput& input);

/// Makes the arrays of a surface in memory, for pictures of it.
/// Preconditions: indices are in range; values are finite. Cost: n log n in the corners.
[[nodiscard]] SurfaceArrays make_surface_arrays(
    const Surface& surface, const Appearance* appearance = nullptr
);

/// Returns the memory that a level takes here while it is replaced, and on the GPU, bytes. Wedges are
/// not in the index: half as many again as there are vertices are counted.
[[nodiscard]] std::uint64_t surface_memory_bytes(
    std::uint64_t vertices,
    std::uint64_t faces,
    std::span<const codec::AttributeInfo> infos,
    bool wireframe
);

}  // namespace vsplit::client
