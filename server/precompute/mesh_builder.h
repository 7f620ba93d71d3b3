#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit::precompute {

/// Tells whether a point can be a vertex: every coordinate finite and within single precision, which
/// is what clients draw and what mesh files hold. Thread safe.
[[nodiscard]] bool is_position(const std::array<double, 3>& point);

/// Says in words that a vertex is none. `vertex`: its index. Result: a BadCoordinate error.
[[nodiscard]] tl::unexpected<Error> bad_position(std::size_t vertex);

/// Calls `visit(i, j, k)` for every triangle of the fan that MeshBuilder::add_polygon() makes of a
/// polygon, the numbers being those of its corners. `corners`: how many it has.
/// Result: the first error that `visit` returns.
template <typename Visit>
[[nodiscard]] Result<void> for_each_fan_triangle(std::size_t corners, Visit visit)
{
    if (corners == 1 || corners == 2)
    {
        return visit(std::size_t{0}, corners - 1, corners - 1);
    }
    for (std::size_t i = 2; i < corners; ++i)
    {
        VSPLIT_TRY(visit(std::size_t{0}, i - 1, i));
    }
    return {};
}

/// Collects the vertices and polygons that a mesh reader finds, and refuses what is not a mesh. Not
/// thread safe. Safe on untrusted input.
class MeshBuilder
{
public:
    /// Makes room. Precondition: the caller has checked both numbers against the size of its input.
    void reserve(std::size_t vertices, std::size_t triangles);

    /// Appends a vertex. `point`: model units. Errors: BadCoordinate unless is_position(),
    /// InputTooLarge.
    [[nodiscard]] Result<void> add_vertex(const std::array<double, 3>& point);

    /// Appends a polygon as a fan of triangles. `corners`: vertex indices from 0; a vertex may come
    /// later. One or two corners make a degenerate triangle, so that the repair report counts them;
    /// none make nothing. Errors: BadIndex when an index can never be one, InputTooLarge.
    [[nodiscard]] Result<void> add_polygon(std::span<const std::int64_t> corners);

    /// Appends the triangles of a strip whose direction alternates; -1 starts a new strip. Triangles
    /// that repeat a vertex only join strips and are left out. Errors: as add_polygon().
    [[nodiscard]] Result<void> add_strip(std::span<const std::int64_t> corners);

    /// Vertices so far.
    [[nodiscard]] std::size_t vertex_count() const { return mesh_.positions.size(); }

    /// Triangles so far.
    [[nodiscard]] std::size_t triangle_count() const { return mesh_.triangles.size(); }

    /// Takes the mesh. Errors: BadIndex when a triangle refers to a vertex that never came, NotAMesh
    /// when there is no vertex, EmptyMesh when there is no triangle. Leaves the builder empty.
    [[nodiscard]] Result<IndexedMesh> finish();

private:
    [[nodiscard]] Result<void> add_triangle(std::int64_t a, std::int64_t b, std::int64_t c);

    IndexedMesh mesh_;
};

}  // namespace vsplit::precompute
