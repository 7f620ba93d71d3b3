#pragma once

#include "codec/stream_encoder.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// A vector in double precision, grid units.
using Vector3 = std::array<double, 3>;

/// Componentwise sum.
[[nodiscard]] inline Vector3 operator+(const Vector3& a, const Vector3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// Componentwise difference.
[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Scales every component.
[[nodiscard]] inline Vector3 operator*(const Vector3& a, double s)
{
    return {a[0] * s, a[1] * s, a[2] * s};
}

/// Inner product.
[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Vector product.
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The neighbours of a vertex, counter-clockwise; on a boundary from one boundary neighbour to the
/// other.
struct OneRing
{
    static constexpr std::size_t kMost = 24;
    std::array<std::uint32_t, kMost> vertex{};
    /// Corner at the centre of the face (centre, vertex[i], vertex[i + 1]).
    std::array<std::int32_t, kMost> corner{};
    std::size_t size = 0;        ///< Neighbours.
    std::size_t face_count = 0;  ///< Faces: size, or size - 1 on a boundary.
    bool boundary = false;
};

/// A corner table (corner 4 * face + k, k = 0 .. 2) in which half-edge collapses are carried out in place.
/// Rings larger than OneRing::kMost are not walked. Not thread safe.
class CollapseMesh
{
public:
    /// Takes over a 2-manifold with boundary. `vertex_count`: vertices, all used by `triangles`.
    /// `wedges`: by triangle the wedges at its corners, as split_wedges() makes them, or empty.
    CollapseMesh(
        std::uint32_t vertex_count,
        std::span<const Triangle> triangles,
        std::span<const Triangle> wedges = {}
    );

    /// Walks the ring of a vertex. Result: false when it has more neighbours than OneRing::kMost.
    [[nodiscard]] bool ring(std::uint32_t vertex, OneRing& ring) const;

    /// Folds the centre of `ring` into its neighbour number `kept`. Precondition: can_collapse().
    void collapse(std::uint32_t removed, const OneRing& ring, std::size_t kept);

    /// Tells whether folding the ring's centre into neighbour number `kept` keeps a manifold whose
    /// vertices have at most `valence_limit` neighbours, and its seams: see keeps_seams().
    /// Precondition: on a boundary ring `kept` is the first or the last neighbour.
    /// Source: Dey, Edelsbrunner, Guha, Nekhayev, "Topology Preserving Edge Contraction", 1999 (link
    /// condition).
    [[nodiscard]] bool can_collapse(
        std::uint32_t removed, const OneRing& ring, std::size_t kept, std::uint32_t valence_limit
    ) const;

    /// Tells whether folding the ring's centre into neighbour number `kept` keeps seams and charts: each
    /// wedge of the centre goes on in one of its own of the kept vertex, seams neither join nor touch,
    /// and no chart vanishes. Always true without wedges. Precondition: as can_collapse().
    /// Source: Dey, Edelsbrunner, Guha, Nekhayev, "Topology Preserving Edge Contraction", 1999 (the link
    /// condition of a subcomplex, which is what seams are).
    [[nodiscard]] bool keeps_seams(std::uint32_t removed, const OneRing& ring, std::size_t kept)
        const;

    /// True when the mesh was given wedges.
    [[nodiscard]] bool has_wedges() const { return !wedges_.empty(); }

    /// True for vertices on a seam. A seam is an edge with different wedges on its two sides at one of
    /// its ends at least; boundaries are none.
    [[nodiscard]] bool is_on_seam(std::uint32_t vertex) const
    {
        return !on_seam_.empty() && on_seam_[vertex] != 0;
    }

    /// Wedge at a corner. Precondition: has_wedges().
    [[nodiscard]] std::uint32_t wedge(std::int32_t c) const
    {
        return wedges_[static_cast<std::size_t>(c >> 2)][static_cast<std::size_t>(c & 3)];
    }

    /// Wedge in which a wedge of the ring's centre goes on when that folds into neighbour number `kept`.
    /// Preconditions: has_wedges(), keeps_seams().
    [[nodiscard]] std::uint32_t next_wedge(
        const OneRing& ring, std::size_t kept, std::uint32_t wedge
    ) const;

    /// Tells what a collapse will take away. Preconditions: has_wedges(), can_collapse().
    [[nodiscard]] codec::SeamRecord seam_record(const OneRing& ring, std::size_t kept) const;
    /// Takes out whole components. `parts`: all of their triangles that are left.
    void remove_parts(std::span<const Triangle> parts);

    /// True for vertices on the boundary.
    [[nodiscard]] bool is_boundary(std::uint32_t vertex) const
    {
        return links_[vertex].boundary != 0;
    }

    /// True for vertices that a collapse folded away or that left with their component.
    [[nodiscard]] bool is_removed(std::uint32_t vertex) const { return links_[vertex].corner < 0; }

    /// Neighbours of a vertex.
    [[nodiscard]] std::uint32_t valence(std::uint32_t vertex) const
    {
        return links_[vertex].valence;
    }

    /// Face across the edge opposite to a corner, or -1.
    [[nodiscard]] std::int32_t face_across(std::int32_t corner) const
    {
        const std::int32_t across = opposite(corner);
        return across < 0 ? -1 : across >> 2;
    }

    /// Corner across the edge opposite to a corner, or -1.
    [[nodiscard]] std::int32_t corner_across(std::int32_t corner) const { return opposite(corner); }

    /// Vertex across the edge opposite to a corner. Precondition: face_across(corner) >= 0.
    [[nodiscard]] std::uint32_t vertex_across(std::int32_t corner) const
    {
        return vertex(opposite(corner));
    }

    /// Vertex at a corner.
    [[nodiscard]] std::uint32_t vertex(std::int32_t c) const
    {
        const Face& face = faces_[static_cast<std::size_t>(c >> 2)];
        return static_cast<std::uint32_t>(face.vertex[static_cast<std::size_t>(c & 3)]);
    }

    /// The next corner of the same face.
    [[nodiscard]] static std::int32_t next(std::int32_t c) { return c + 1 - 3 * ((c >> 1) & 1); }

    /// The previous corner of the same face.
    [[nodiscard]] static std::int32_t previous(std::int32_t c)
    {
        return c + 2 - 3 * ((c | (c >> 1)) & 1);
    }

    /// A corner of a vertex that is not removed; on the boundary that of its first face.
    [[nodiscard]] std::int32_t first_corner(std::uint32_t vertex) const
    {
        std::int32_t corner = links_[vertex].corner;
        while (is_boundary(vertex) && opposite(previous(corner)) >= 0)
        {
            corner = previous(opposite(previous(corner)));
        }
        return corner;
    }

    /// The corner of the same vertex in the next face, counter-clockwise; -1 at the boundary.
    [[nodiscard]] std::int32_t next_around(std::int32_t corner) const
    {
        const std::int32_t across = opposite(next(corner));
        return across < 0 ? -1 : next(across);
    }

    /// True for faces that no collapse has dropped and whose component is there.
    [[nodiscard]] bool has_face(std::uint32_t face) const { return faces_[face].vertex[0] >= 0; }

    /// Vertices of a face. Precondition: has_face().
    [[nodiscard]] Triangle triangle(std::uint32_t face) const
    {
        const auto corner = static_cast<std::int32_t>(4 * face);
        return {vertex(corner), vertex(corner + 1), vertex(corner + 2)};
    }

    /// Copies the triangles that are left.
    [[nodiscard]] std::vector<Triangle> triangles() const;

    /// Lists the numbers of the triangles that are left, in the order of triangles().
    [[nodiscard]] std::vector<std::uint32_t> faces() const;

    /// Copies the wedges of the triangles that are left, in the order of triangles(); empty without.
    [[nodiscard]] std::vector<Triangle> wedges() const;

    /// Copies the vertices that are left, ascending.
    [[nodiscard]] std::vector<std::uint32_t> vertices() const;

private:
    [[nodiscard]] std::int32_t opposite(std::int32_t c) const
    {
        return faces_[static_cast<std::size_t>(c >> 2)].opposite[static_cast<std::size_t>(c & 3)];
    }

    /// Half a cache line, aligned, for walks go from face to face.
    struct alignas(32) Face
    {
        std::array<std::int32_t, 4> vertex{-1, -1, -1, -1};    ///< By corner; -1 in removed faces.
        std::array<std::int32_t, 4> opposite{-1, -1, -1, -1};  ///< By corner; -1 at the boundary.
    };

    /// What is known of a vertex.
    struct Link
    {
        std::int32_t corner = -1;  ///< One of its corners; -1 when removed.
        std::uint32_t valence : 31 = 0;
        std::uint32_t boundary : 1 = 0;
    };

    template <typename Visit>
    void for_each_corner(const Visit& visit) const
    {
        for (std::int32_t c = 0; c < static_cast<std::int32_t>(4 * faces_.size()); c += 4)
        {
            visit(c);
            visit(c + 1);
            visit(c + 2);
        }
    }

    void set_opposite(std::int32_t c, std::int32_t opposite)
    {
        Face& face = faces_[static_cast<std::size_t>(c >> 2)];
        face.opposite[static_cast<std::size_t>(c & 3)] = opposite;
    }

    [[nodiscard]] bool is_seam(std::int32_t c) const;
    [[nodiscard]] std::size_t seams_at(const OneRing& ring) const;
    void mark_seams();
    void fold_wedges(const OneRing& ring, std::size_t kept);
    void link_opposites();
    void link(std::int32_t a, std::int32_t b);

    std::vector<Face> faces_;
    std::vector<Link> links_;            ///< By vertex.
    std::vector<Triangle> wedges_;       ///< By face the wedges at its corners; or empty.
    std::vector<std::uint8_t> on_seam_;  ///< By vertex; empty without wedges.
};

}  // namespace vsplit::precompute
