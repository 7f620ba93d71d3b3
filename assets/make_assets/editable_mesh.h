#pragma once

#include "make_assets/vector3.h"
#include "mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace vsplit::assets {

/// A manifold triangle mesh whose edges can be split, collapsed and flipped. Not thread safe.
class EditableMesh
{
public:
    /// The two ends of an edge.
    using Edge = std::pair<std::uint32_t, std::uint32_t>;

    /// `mesh`: a 2-manifold, with or without boundary.
    explicit EditableMesh(const IndexedMesh& mesh);

    /// Number of vertices, collapsed ones included.
    [[nodiscard]] std::uint32_t vertex_count() const
    {
        return static_cast<std::uint32_t>(positions_.size());
    }

    /// False once the vertex was collapsed.
    [[nodiscard]] bool is_alive(std::uint32_t vertex) const { return !faces_[vertex].empty(); }

    /// True when the vertex lies on a boundary.
    [[nodiscard]] bool is_boundary(std::uint32_t vertex) const;

    /// Where the vertex is.
    [[nodiscard]] const Vector3& position(std::uint32_t vertex) const { return positions_[vertex]; }

    /// Moves a vertex.
    void move(std::uint32_t vertex, const Vector3& position) { positions_[vertex] = position; }

    /// The faces round a vertex, in no particular order.
    [[nodiscard]] std::span<const std::uint32_t> faces(std::uint32_t vertex) const
    {
        return faces_[vertex];
    }

    /// The corners of a face.
    [[nodiscard]] const Triangle& triangle(std::uint32_t face) const { return triangles_[face]; }

    /// Twice the area of a face times its unit normal.
    [[nodiscard]] Vector3 area_normal(std::uint32_t face) const;

    /// The vertices that share an edge with `vertex`, ascending.
    [[nodiscard]] std::vector<std::uint32_t> neighbours(std::uint32_t vertex) const;

    /// All edges, ascending.
    [[nodiscard]] std::vector<Edge> edges() const;

    /// Distance of an edge's ends.
    [[nodiscard]] double edge_length(const Edge& edge) const
    {
        return length(positions_[edge.first] - positions_[edge.second]);
    }

    /// Puts a new vertex at `position` on an inner edge. False, and nothing done, when the edge does not
    /// exist or is a boundary edge.
    bool split(const Edge& edge, const Vector3& position);

    /// Collapses an edge into its first vertex, which moves to `position`. False, and nothing done, when
    /// the edge does not exist, the mesh would not stay manifold, a face would turn over, or the
    /// second vertex lies on a boundary.
    bool collapse(std::uint32_t kept, std::uint32_t removed, const Vector3& position);

    /// Turns an inner edge round in its two faces. False, and nothing done, when the edge does not
    /// exist, the turned one does already, or the two faces would fold over.
    bool flip(const Edge& edge);

    /// The vertices opposite an inner edge, left and right of first to second; false without one.
    [[nodiscard]] bool opposite(const Edge& edge, Edge& vertices) const;

    /// The mesh without the gaps that collapses left.
    [[nodiscard]] IndexedMesh compact() const;

private:
    // The face in which `to` follows `from`, or the number of faces.
    [[nodiscard]] std::uint32_t face_left_of(std::uint32_t from, std::uint32_t to) const;
    [[nodiscard]] std::uint32_t third_corner(std::uint32_t face, std::uint32_t a, std::uint32_t b)
        const;
    [[nodiscard]] bool turns_over(
        std::uint32_t vertex, std::uint32_t other, const Vector3& position
    ) const;
    void detach(std::uint32_t vertex, std::uint32_t face);
    void replace_corner(std::uint32_t face, std::uint32_t from, std::uint32_t to);

    std::vector<Vector3> positions_;
    std::vector<Triangle> triangles_;  // a removed one repeats its first corner
    std::vector<std::vector<std::uint32_t>> faces_;
};

}  // namespace vsplit::assets
