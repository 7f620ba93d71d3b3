#include "codec/grown_mesh.h"

namespace vsplit::codec {
namespace {

Corner corner_at(std::int32_t face, Corner k)
{
    return face * 4 + k;
}

}  // namespace

void GrownMesh::reserve(std::uint32_t vertices, std::uint32_t faces)
{
    faces_.reserve(faces);
    incident_.assign(vertices, 0);
    most_edges_ = most_border_edges(faces);
    nodes_.reserve(most_edges_);
}

void GrownMesh::count(std::uint32_t vertex)
{
    std::uint8_t& faces = incident_[vertex];
    faces = static_cast<std::uint8_t>(faces + (faces < 255));
}

std::int32_t GrownMesh::add_node(Corner corner)
{
    std::int32_t index = free_;
    if (index >= 0)
    {
        free_ = node(index).next;
    }
    else
    {
        index = static_cast<std::int32_t>(nodes_.size());
        nodes_.emplace_back();
    }
    set_corner(index, corner);
    ++border_edges_;
    return index;
}

void GrownMesh::free_node(std::int32_t index)
{
    node(index) = {-1, free_, -1};
    --border_edges_;
    free_ = index;
}

void GrownMesh::set_corner(std::int32_t index, Corner corner)
{
    node(index).corner = corner;
    opposite_of(corner) = -2 - index;
}

void GrownMesh::connect(std::int32_t first, std::int32_t second)
{
    node(first).next = second;
    node(second).previous = first;
}

void GrownMesh::glue(Corner a, Corner b)
{
    opposite_of(a) = b;
    opposite_of(b) = a;
}

std::int32_t GrownMesh::add_seed()
{
    if (!has_room(3))
    {
        return -1;
    }
    const auto face = static_cast<std::int32_t>(faces_.size());
    faces_.push_back({{vertex_count_, vertex_count_ + 1, vertex_count_ + 2}, {-1, -1, -1}});
    seeds_.push_back(face);
    for (std::uint32_t k = 0; k < 3; ++k)
    {
        count(vertex_count_ + k);
    }
    vertex_count_ += 3;
    const std::int32_t first = add_node(corner_at(face, 0));
    const std::int32_t second = add_node(corner_at(face, 1));
    const std::int32_t third = add_node(corner_at(face, 2));
    connect(first, second);
    connect(second, third);
    connect(third, first);
    return face;
}

BorderGate GrownMesh::gate(Corner corner) const
{
    BorderGate gate;
    gate.corner = corner;
    gate.node = node_at(corner);
    const Node& here = nodes_[static_cast<std::size_t>(gate.node)];
    gate.previous = here.previous;
    gate.next = here.next;
    const Node& previous = nodes_[static_cast<std::size_t>(here.previous)];
    const Node& next = nodes_[static_cast<std::size_t>(here.next)];
    gate.from = vertex(next_corner(corner));
    gate.to = vertex(previous_corner(corner));
    gate.before = vertex(next_corner(corner_of(previous)));
    gate.behind = vertex(previous_corner(corner_of(next)));
    gate.previous_closed = previous.corner < 0;
    gate.next_closed = next.corner < 0;
    return gate;
}

std::int32_t GrownMesh::add_face(const BorderGate& gate, std::uint32_t tip)
{
    const auto face = static_cast<std::int32_t>(faces_.size());
    faces_.push_back({{tip, gate.to, gate.from}, {-1, -1, -1}});
    glue(corner_at(face, 0), gate.corner);
    count(tip);
    count(gate.to);
    count(gate.from);
    return face;
}

bool GrownMesh::grow_new(const BorderGate& gate)
{
    if (!has_room(1))
    {
        return false;
    }
    const std::int32_t face = add_face(gate, vertex_count_++);
    set_corner(gate.node, corner_at(face, 1));
    const std::int32_t second = add_node(corner_at(face, 2));
    connect(second, gate.next);
    connect(gate.node, second);
    return true;
}

bool GrownMesh::grow_previous(const BorderGate& gate)
{
    if (gate.previous_closed || gate.before == gate.to || gate.previous == gate.next)
    {
        return false;
    }
    const std::int32_t face = add_face(gate, gate.before);
    glue(corner_at(face, 1), node(gate.previous).corner);
    const std::int32_t before = node(gate.previous).previous;
    const bool last = before == gate.next && !gate.next_closed;
    free_node(gate.previous);
    if (last)
    {
        glue(corner_at(face, 2), node(gate.next).corner);
        free_node(gate.next);
        free_node(gate.node);
        return true;
    }
    set_corner(gate.node, corner_at(face, 2));
    connect(before, gate.node);
    return true;
}

bool GrownMesh::grow_next(const BorderGate& gate)
{
    if (gate.next_closed || gate.behind == gate.from || gate.previous == gate.next)
    {
        return false;
    }
    const std::int32_t face = add_face(gate, gate.behind);
    glue(corner_at(face, 2), node(gate.next).corner);
    const std::int32_t behind = node(gate.next).next;
    free_node(gate.next);
    set_corner(gate.node, corner_at(face, 1));
    connect(gate.node, behind);
    return true;
}

bool GrownMesh::grow_touching(const BorderGate& gate, std::uint32_t where)
{
    if (!has_room(1) || where >= nodes_.size() || nodes_[where].previous < 0)
    {
        return false;
    }
    const auto target = static_cast<std::int32_t>(where);
    const std::uint32_t tip = vertex(next_corner(corner_of(nodes_[where])));
    if (tip == gate.from || tip == gate.to)
    {
        return false;
    }
    const std::int32_t face = add_face(gate, tip);
    const std::int32_t before = node(target).previous;
    set_corner(gate.node, corner_at(face, 1));
    const std::int32_t second = add_node(corner_at(face, 2));
    connect(gate.node, target);
    connect(before, second);
    connect(second, gate.next);
    return true;
}

void GrownMesh::close(const BorderGate& gate)
{
    node(gate.node).corner = ~gate.corner;
}

void GrownMesh::finish()
{
    nodes_ = {};
    free_ = -1;
    border_edges_ = 0;
    incident_ = {};
}

}  // namespace vsplit::codec
