#pragma once

// Based on: Gumhold, Strasser, "Real Time Compression of Triangle Mesh Connectivity", 1998 (cut-border
// machine). The complete mesh grows face by face from seeds; the loops of edges that still lack a face
// are kept as linked lists.

#include "codec/refinement_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// A face of a mesh that grows. A corner across is negative where there is none (yet).
struct GrownFace
{
    std::array<std::uint32_t, 3> vertex{};
    std::array<Corner, 3> opposite{-1, -1, -1};
};

/// How the face beyond an edge of the border continues the mesh.
enum class GrowthStep : std::uint8_t
{
    NewVertex,  ///< Its third vertex is new.
    Previous,   ///< It also has the previous edge of the border.
    Next,       ///< It also has the next edge of the border.
    Touch,      ///< Its third vertex lies on the border elsewhere.
    Boundary,   ///< There is no face: the edge lies on the boundary of the mesh.
};

/// An edge of the border from `from` to `to`, with what lies before and behind it on its loop.
struct BorderGate
{
    std::int32_t node = -1;
    Corner corner = -1;  ///< Across from the edge, in the face that is there.
    std::int32_t previous = -1;
    std::int32_t next = -1;
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t before = 0;      ///< Where the previous edge begins.
    std::uint32_t behind = 0;      ///< Where the next edge ends.
    bool previous_closed = false;  ///< The previous edge is boundary.
    bool next_closed = false;      ///< The next edge is boundary.
};

/// Faces in the order in which they were grown, vertices numbered in that order, and the border.
/// Every operation keeps the links consistent whatever the operations are, so hostile orders give odd
/// meshes, never bad memory. Not thread safe.
class GrownMesh
{
public:
    /// Reserves room for the whole mesh.
    void reserve(std::uint32_t vertices, std::uint32_t faces);

    /// Edges that the border of a mesh of so many faces may have: far more than meshes of any use
    /// need, few enough to bound the memory.
    [[nodiscard]] static constexpr std::uint32_t most_border_edges(std::uint32_t faces)
    {
        return faces / 8 + 1024;
    }

    /// Adds a face of three new vertices whose edges become a loop of the border. Returns it, or -1 when
    /// the border is as long as it may be. Precondition: room.
    [[nodiscard]] std::int32_t add_seed();

    /// Describes the border's edge across from a corner. Precondition: is_open(corner).
    [[nodiscard]] BorderGate gate(Corner corner) const;

    /// True while the edge across from a corner is on the border and may still get a face.
    [[nodiscard]] bool is_open(Corner corner) const
    {
        const std::int32_t link = opposite(corner);
        return link < -1 && nodes_[static_cast<std::size_t>(-2 - link)].corner >= 0;
    }

    /// Grows a face with a new vertex. False, and nothing done, when the border is as long as it may
    /// be. Precondition: room for both.
    [[nodiscard]] bool grow_new(const BorderGate& gate);

    /// Grows the face that closes the gap to the previous edge. False, and nothing done, when there is
    /// no such face: that edge is boundary, or the loop has two edges.
    [[nodiscard]] bool grow_previous(const BorderGate& gate);

    /// Grows the face that closes the gap to the next edge. False as for grow_previous().
    [[nodiscard]] bool grow_next(const BorderGate& gate);

    /// Grows the face whose third vertex is where the border's edge `node` begins. False, and nothing
    /// done, when `node` is none, the vertex is an end of the gate or the border is full.
    [[nodiscard]] bool grow_touching(const BorderGate& gate, std::uint32_t node);

    /// Makes the edge a boundary of the mesh.
    void close(const BorderGate& gate);

    /// Turns what is left of the border into boundary and frees what only growing needs.
    void finish();

    /// Frees everything.
    void clear() { *this = GrownMesh(); }

    /// The border's edge after one.
    [[nodiscard]] std::int32_t next_on_border(std::int32_t node) const
    {
        return nodes_[static_cast<std::size_t>(node)].next;
    }

    /// The border's edge before one.
    [[nodiscard]] std::int32_t previous_on_border(std::int32_t node) const
    {
        return nodes_[static_cast<std::size_t>(node)].previous;
    }

    /// The border's edge across from a corner; -1 when it is not on the border.
    [[nodiscard]] std::int32_t node_at(Corner corner) const
    {
        const std::int32_t link = opposite(corner);
        return link < -1 ? -2 - link : -1;
    }

    /// Nodes that were ever in use: all numbers of nodes are below.
    [[nodiscard]] std::uint32_t node_count() const
    {
        return static_cast<std::uint32_t>(nodes_.size());
    }

    /// Faces that touch a vertex so far, at most 255.
    [[nodiscard]] std::uint8_t incident(std::uint32_t vertex) const { return incident_[vertex]; }

    /// Vertices so far.
    [[nodiscard]] std::uint32_t vertex_count() const { return vertex_count_; }

    /// Faces so far.
    [[nodiscard]] std::uint32_t face_count() const
    {
        return static_cast<std::uint32_t>(faces_.size());
    }

    /// Faces in the order in which they were grown.
    [[nodiscard]] std::vector<GrownFace>& faces() { return faces_; }

    /// The same, read only.
    [[nodiscard]] const std::vector<GrownFace>& faces() const { return faces_; }

    /// First faces of the components, in order.
    [[nodiscard]] const std::vector<std::int32_t>& seeds() const { return seeds_; }

    /// Vertex at a corner.
    [[nodiscard]] std::uint32_t vertex(Corner corner) const
    {
        return faces_[static_cast<std::size_t>(corner >> 2)]
            .vertex[static_cast<std::size_t>(corner & 3)];
    }

    /// Corner across the edge opposite to a corner; negative when there is none.
    [[nodiscard]] Corner opposite(Corner corner) const
    {
        return faces_[static_cast<std::size_t>(corner >> 2)]
            .opposite[static_cast<std::size_t>(corner & 3)];
    }

private:
    /// An edge of the border. `corner` is complemented when the edge is boundary.
    struct Node
    {
        Corner corner = -1;
        std::int32_t next = -1;
        std::int32_t previous = -1;
    };

    static Corner corner_of(const Node& node)
    {
        return node.corner < 0 ? ~node.corner : node.corner;
    }

    Corner& opposite_of(Corner corner)
    {
        return faces_[static_cast<std::size_t>(corner >> 2)]
            .opposite[static_cast<std::size_t>(corner & 3)];
    }

    Node& node(std::int32_t index) { return nodes_[static_cast<std::size_t>(index)]; }

    [[nodiscard]] bool has_room(std::uint32_t edges) const
    {
        return border_edges_ + edges <= most_edges_;
    }

    std::int32_t add_face(const BorderGate& gate, std::uint32_t tip);
    std::int32_t add_node(Corner corner);
    void free_node(std::int32_t index);
    void set_corner(std::int32_t index, Corner corner);
    void connect(std::int32_t first, std::int32_t second);
    void glue(Corner a, Corner b);
    void count(std::uint32_t vertex);

    std::vector<GrownFace> faces_;
    std::vector<Node> nodes_;
    std::vector<std::int32_t> seeds_;
    std::vector<std::uint8_t> incident_;
    std::int32_t free_ = -1;
    std::uint32_t border_edges_ = 0;
    std::uint32_t most_edges_ = 0;
    std::uint32_t vertex_count_ = 0;
};

}  // namespace vsplit::codec
