#pragma once

#include "make_assets/vector3.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace vsplit::assets {

/// A polyline; as a loop, its last point is followed by its first.
using Polyline = std::vector<Vector3>;

/// Appends the points from the last point of `line` (not included) to `end` on a straight line.
/// `line`: not empty; `steps`: how many points, at least 1.
void line_to(Polyline& line, const Vector3& end, int steps);

/// Appends the points from the last point of `line` (not included) to `end` on the arc round `centre`,
/// which must be shorter than half a circle. `halvings`: 2^halvings points.
void arc_to(Polyline& line, const Vector3& centre, const Vector3& end, int halvings);

/// A circle of 4 * 2^halvings points from centre + u * radius towards centre + v * radius;
/// `u`, `v`: unit length, orthogonal.
[[nodiscard]] Polyline circle(
    const Vector3& centre, const Vector3& u, const Vector3& v, double radius, int halvings
);

/// Joins patches to a mesh: points closer than about a hundred-thousandth of a unit become one vertex.
class PatchBuilder
{
public:
    /// Fills the band between two loops of as many points each that start next to each other, `inner`
    /// on the left of `outer`. `rows`: rows of cells, at least 1.
    void fill_band(const Polyline& outer, const Polyline& inner, int rows);

    /// Fills the strip between two lines of as many points each, `left` on the left of `right`.
    void fill_strip(const Polyline& right, const Polyline& left, int rows);

    /// Fills a plane polygon by cutting off the best ear. `loop`: counter-clockwise seen along -`normal`;
    /// `hole`: a loop inside that turns the same way, or nothing.
    void fill_polygon(const Polyline& loop, const Vector3& normal, const Polyline& hole = {});

    /// Adds the mirror image of everything so far in the plane z = 0.
    void add_mirror_image();

    /// The mesh; the builder is empty afterwards.
    [[nodiscard]] IndexedMesh take() { return std::move(mesh_); }

private:
    [[nodiscard]] std::uint32_t vertex(const Vector3& point);
    void add_triangle(const Vector3& a, const Vector3& b, const Vector3& c);

    IndexedMesh mesh_;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> vertices_;
};

/// Flips edges inside plane faces while that makes the worse one of two triangles better.
/// `mesh`: a 2-manifold. Result: the same surface, its plane parts Delaunay.
/// Source: Lawson, "Software for C1 Surface Interpolation", 1977.
[[nodiscard]] IndexedMesh flip_flat_edges(const IndexedMesh& mesh);

}  // namespace vsplit::assets
