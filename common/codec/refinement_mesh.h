#pragma once

#include "codec/triangle_updates.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// A corner is 4 * face + k, k = 0 .. 2: the k-th vertex of a face, and the edge across from it.
/// -1 stands for "no corner".
using Corner = std::int32_t;

/// The face that a corner belongs to; -1 for no corner.
[[nodiscard]] inline std::int32_t face_of(Corner corner)
{
    return corner >> 2;
}

/// The next corner of the same face, counter-clockwise.
[[nodiscard]] inline Corner next_corner(Corner corner)
{
    return corner + 1 - 3 * ((corner >> 1) & 1);
}

/// The previous corner of the same face.
[[nodiscard]] inline Corner previous_corner(Corner corner)
{
    return corner + 2 - 3 * ((corner | (corner >> 1)) & 1);
}

/// Where a face stands in the traversal of a batch.
enum class FaceState : std::uint8_t
{
    Free = 0,       ///< May still belong to a split.
    Taken = 1,      ///< In a wedge, or made by a split of this batch.
    Refused = 2,    ///< Asked, belongs to no split.
    Boundary = 3,   ///< Not a face: what lies across a boundary edge.
    SeedOfOne = 4,  ///< In a wedge, the face asked; its split added one face.
    SeedOfTwo = 5,  ///< In a wedge, the face asked; its split added two faces.
};

/// A triangle with its neighbours. 32 bytes, so that two share a cache line.
struct alignas(32) Face
{
    std::array<std::uint32_t, 3> vertex{};
    std::array<Corner, 3> opposite{-1, -1, -1};  ///< Corner across the edge opposite to corner k.
    std::array<std::uint8_t, 3> edge_log{};  ///< 8 log2(1 + squared length) of the opposite edge.
    FaceState state = FaceState::Free;
    std::uint32_t slot = 0;  ///< Its place in the triangle list that callers see.

    /// Between two batches: where the face goes in the new order, kept where the edge logs and the
    /// state are while a batch is coded.
    [[nodiscard]] std::uint32_t place() const
    {
        return edge_log[0] | static_cast<std::uint32_t>(edge_log[1]) << 8 |
               static_cast<std::uint32_t>(edge_log[2]) << 16 |
               static_cast<std::uint32_t>(state) << 24;
    }

    /// Sets place(); edge logs and state are lost.
    void set_place(std::uint32_t place)
    {
        edge_log = {
            static_cast<std::uint8_t>(place),
            static_cast<std::uint8_t>(place >> 8),
            static_cast<std::uint8_t>(place >> 16)};
        state = static_cast<FaceState>(place >> 24);
    }
};

/// A grid position in units of 2^shift cells; the coordinates are integers held in floats, exact to
/// 2^24.
struct Point
{
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
};

/// How the wedge of a split touches the boundary.
enum class SplitKind : std::uint8_t
{
    Interior = 0,      ///< Two new faces.
    BoundaryLeft = 1,  ///< The wedge ends at the boundary on its left: one new face, on the right.
    BoundaryRight =
        2,  ///< The wedge begins at the boundary on its right: one new face, on the left.
};

/// A vertex split: `wedge` consecutive faces around the kept vertex pass to the removed vertex.
///
///            left                          left
///           /    \                        / | |
///      ... /      \ wedge          ... / new| \ wedge
///        kept------ ...     ==>      kept---removed ...
///          \      / faces             \ new | /  faces
///           \    /                        \ | |
///            right                         right
///
/// Glossary (Hoppe 1996 / OpenMesh): kept = v1, removed = v0, left = vl, right = vr.
struct Split
{
    Corner first = -1;        ///< Corner at the kept vertex of the wedge's first (rightmost) face.
    std::uint8_t wedge = 0;   ///< Faces in the wedge, 1 .. kMaxWedge.
    std::uint8_t before = 0;  ///< Faces of the wedge before its seed, the face that was asked.
    SplitKind kind = SplitKind::Interior;
};

/// Longest wedge; the removed vertex has at most kMaxWedge + 2 neighbours.
inline constexpr int kMaxWedge = 4;

/// Valence that a RefinementMesh no longer counts exactly.
inline constexpr std::uint16_t kManyNeighbours = 65535;

/// The mesh while it is refined: faces with neighbours in an order that keeps neighbours close in
/// memory, positions on the current grid, valences. All memory is reserved up front, and nothing but the
/// final mesh needs any: while a batch is coded, its new faces stand at the end of the reserved room, the
/// newest first, and the next batch's start sorts them in. Shared by decoder and encoder. Not thread safe.
class RefinementMesh
{
public:
    /// Reserves room for the final mesh.
    void reserve(std::uint32_t vertices, std::uint32_t faces);

    /// Takes over a base mesh whose positions are in units of 2^shift cells.
    /// `max_index`: largest coordinate on that grid. Errors: BadChunk when an index or a coordinate is
    /// out of range or the triangles are not a consistently oriented 2-manifold with boundary; the mesh
    /// is empty then.
    /// Precondition: it fits the reservation. Safe on untrusted input.
    [[nodiscard]] Result<void> set_base(const GridMesh& base, std::int32_t max_index);

    /// Ends the batch before, as start_batch() does, and puts components behind everything that is there:
    /// their vertices get the next numbers, their triangles the next slots and the next places.
    /// Arguments, errors and precondition as set_base()'s; after an error the mesh is as it was before.
    /// Safe on untrusted input.
    [[nodiscard]] Result<void> add_parts(const GridMesh& parts, std::int32_t max_index);

    /// Ends the batch before, if there was one: its new faces move beside the face whose wedge they came
    /// from, so that neighbours stay close in memory; slots do not change. Then prepares the next one:
    /// measures every edge and frees every face. Faces 0 .. face_count() - 1 are in order then.
    void start_batch();

    /// Carries out splits of the batch; the removed vertices' positions must be in place at
    /// vertex_count() onwards.
    /// Precondition: room for the new faces; splits as the connectivity coder made them.
    void apply(std::span<const Split> splits);

    /// All faces: those from before the batch, then those that it added, the newest first.
    [[nodiscard]] std::array<std::span<const Face>, 2> face_ranges() const
    {
        return {
            std::span(faces(), batch_start_),
            std::span(faces() + face_capacity() - added_count(), added_count())};
    }

    /// Number of faces that a chunk's splits add.
    [[nodiscard]] static std::uint32_t added_faces(std::span<const Split> splits);

    /// Vertices of the mesh now.
    [[nodiscard]] std::uint32_t vertex_count() const { return vertex_count_; }

    /// Faces of the mesh now.
    [[nodiscard]] std::uint32_t face_count() const { return face_count_; }

    /// Faces for which memory is reserved.
    [[nodiscard]] std::uint32_t face_capacity() const
    {
        return static_cast<std::uint32_t>(storage_.size() - 1);
    }

    /// Faces that the batch added; they have the indices below face_capacity().
    [[nodiscard]] std::uint32_t added_count() const { return face_count_ - batch_start_; }

    /// Faces by index; index -1 is valid and has state Boundary.
    [[nodiscard]] Face* faces() { return storage_.data() + 1; }

    /// Faces by index, read only.
    [[nodiscard]] const Face* faces() const { return storage_.data() + 1; }

    /// Positions by vertex, including those of removed vertices not yet applied.
    [[nodiscard]] Point* points() { return points_.data(); }

    /// Positions by vertex, read only.
    [[nodiscard]] const Point* points() const { return points_.data(); }

    /// Valences by vertex (edges); kManyNeighbours stands for that many or more and never changes.
    [[nodiscard]] std::uint16_t* valences() { return valences_.data(); }

    /// Vertex at a corner.
    [[nodiscard]] std::uint32_t vertex(Corner corner) const
    {
        return faces()[face_of(corner)].vertex[static_cast<std::size_t>(corner & 3)];
    }

    /// Corner across the edge opposite to a corner; -1 at the boundary.
    [[nodiscard]] Corner opposite(Corner corner) const
    {
        return faces()[face_of(corner)].opposite[static_cast<std::size_t>(corner & 3)];
    }

private:
    void link(Corner a, Corner b);
    void apply(const Split& split);
    void finish_batch();
    void assign_places();
    void sort_in_added();
    void follow_places();
    [[nodiscard]] Result<void> take(const GridMesh& mesh, std::int32_t max_index);
    [[nodiscard]] Result<void> link_from(std::uint32_t first_face);
    [[nodiscard]] Result<void> check_fans(std::uint32_t first_vertex, std::uint32_t first_face);
    std::int32_t add_face(std::array<std::uint32_t, 3> vertices, const Face& like);
    void split_right(const Split& split, std::uint32_t kept, std::uint32_t removed);
    void split_left(const Split& split, Corner last, std::uint32_t kept, std::uint32_t removed);

    /// One sentinel, which is there from the beginning, then the faces.
    std::vector<Face> storage_ = std::vector<Face>(1, Face{.state = FaceState::Boundary});
    std::vector<Point> points_;
    std::vector<std::uint16_t> valences_;
    std::uint32_t vertex_count_ = 0;
    std::uint32_t face_count_ = 0;
    std::uint32_t batch_start_ = 0;  ///< Faces when the batch started.
};

}  // namespace vsplit::codec
