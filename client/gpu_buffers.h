#pragma once

#include "codec/stream_decoder.h"
#include "dirty_pages.h"
#include "mesh/indexed_mesh.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vsplit::client {

/// One vertex as the vertex shader reads it.
struct GpuVertex
{
    std::array<float, 3> position{};       ///< Model units.
    std::array<std::int32_t, 3> normal{};  ///< Sum over the triangles around it; not normalised.
    /// Sum of the lengths of what was summed: |normal| / weight is 1 where the surface is flat.
    std::int32_t weight = 0;

    /// Memberwise equality.
    friend bool operator==(const GpuVertex&, const GpuVertex&) = default;
};

/// Writes the positions of `count` vertices from `first` on into `out`, x y z each.
using PositionSource =
    std::function<void(std::uint32_t first, std::uint32_t count, std::span<float> out)>;

/// Writes all triangles of the mesh.
using TriangleSource = std::function<void(std::span<Triangle> out)>;

/// The vertex and index arrays that the GPU draws, kept up to date in time proportional to what
/// changed: vertices are appended, triangles keep their slot, and smooth normals change only around
/// changed triangles. Normals are sums of integers, so taking a triangle away restores exactly what
/// was there before, and the arrays equal a rebuild from scratch bit by bit. No GL in here; upload
/// the dirty ranges. Not thread safe.
/// Source of the normals' weight: between equal weights and Gouraud's area weights, see the .cpp.
class GpuBuffers
{
public:
    /// `diagonal`: of the bounding box, model units, > 0; sets the scale of the integer normals.
    explicit GpuBuffers(double diagonal);

    /// Reserves memory for a mesh of so many vertices and triangles.
    void reserve(std::uint32_t vertices, std::uint32_t faces);

    /// Follows one step of the decoder.
    /// `step`: of kind Chunk, in the decoder's order, none left out; `positions`: of the mesh after it;
    /// `triangles`: those of the mesh after it, asked only when step.triangles_replaced.
    /// Preconditions: triangles refer to vertices below step.vertices, slots are below step.faces.
    /// Cost: linear in new vertices and changed triangles; linear in the mesh when known positions
    /// moved (step.first_moved_vertex < step.first_new_vertex) or all triangles were replaced.
    void apply(
        const codec::Step& step,
        const PositionSource& positions,
        const TriangleSource& triangles = {}
    );

    /// The vertex array.
    [[nodiscard]] std::span<const GpuVertex> vertices() const { return vertices_; }

    /// The index array, one triangle a slot.
    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }

    /// Vertices to upload since the last call, as ascending runs.
    [[nodiscard]] std::vector<ElementRange> take_dirty_vertices();

    /// Triangles to upload since the last call, as ascending runs.
    [[nodiscard]] std::vector<ElementRange> take_dirty_triangles();

    /// Returns the memory that arrays of this size take here and on the GPU, bytes.
    /// `wireframe`: with the GPU's index array for lines.
    [[nodiscard]] static std::uint64_t memory_bytes(
        std::uint64_t vertices, std::uint64_t faces, bool wireframe
    );

private:
    void write_positions(std::uint32_t first, std::uint32_t end, const PositionSource& positions);
    void add_normal(const Triangle& triangle, bool add);
    void replace_triangle(const codec::TriangleUpdate& update);
    void rebuild_normals();

    double to_unit_ = 1.0;
    std::vector<GpuVertex> vertices_;
    std::vector<Triangle> triangles_;
    DirtyPages dirty_vertices_;
    DirtyPages dirty_triangles_;
};

}  // namespace vsplit::client
