#include "make_assets/editable_mesh.h"

#include <algorithm>
#include <limits>

namespace vsplit::assets {

namespace {

constexpr double kLeastCosine = 0.3;  // a face may turn by about 70 degrees at most

bool has_corner(const Triangle& triangle, std::uint32_t vertex)
{
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

}  // namespace

EditableMesh::EditableMesh(const IndexedMesh& mesh)
    : triangles_(mesh.triangles), faces_(mesh.positions.size())
{
    positions_.reserve(mesh.positions.size());
    for (const auto& position : mesh.positions)
    {
        positions_.push_back(to_vector(position));
    }
    for (std::uint32_t face = 0; face < triangles_.size(); ++face)
    {
        for (const std::uint32_t vertex : triangles_[face])
        {
            faces_[vertex].push_back(face);
        }
    }
}

bool EditableMesh::is_boundary(std::uint32_t vertex) const
{
    return neighbours(vertex).size() != faces_[vertex].size();
}

Vector3 EditableMesh::area_normal(std::uint32_t face) const
{
    const auto [a, b, c] = triangles_[face];
    return cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
}

std::vector<std::uint32_t> EditableMesh::neighbours(std::uint32_t vertex) const
{
    std::vector<std::uint32_t> result;
    for (const std::uint32_t face : faces_[vertex])
    {
        std::copy_if(
            triangles_[face].begin(),
            triangles_[face].end(),
            std::back_inserter(result),
            [vertex](std::uint32_t corner) { return corner != vertex; }
        );
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

std::vector<EditableMesh::Edge> EditableMesh::edges() const
{
    std::vector<Edge> result;
    for (std::uint32_t vertex = 0; vertex < vertex_count(); ++vertex)
    {
        for (const std::uint32_t neighbour : neighbours(vertex))
        {
            if (vertex < neighbour)
            {
                result.emplace_back(vertex, neighbour);
            }
        }
    }
    return result;
}

std::uint32_t EditableMesh::face_left_of(std::uint32_t from, std::uint32_t to) const
{
    for (const std::uint32_t face : faces_[from])
    {
        const Triangle& t = triangles_[face];
        if ((t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) ||
            (t[2] == from && t[0] == to))
        {
            return face;
        }
    }
    return static_cast<std::uint32_t>(triangles_.size());
}

std::uint32_t EditableMesh::third_corner(std::uint32_t face, std::uint32_t a, std::uint32_t b) const
{
    const Triangle& t = triangles_[face];
    return *std::find_if(t.begin(), t.end(), [a, b](std::uint32_t v) { return v != a && v != b; });
}

bool EditableMesh::opposite(const Edge& edge, Edge& vertices) const
{
    const std::uint32_t left = face_left_of(edge.first, edge.second);
    const std::uint32_t right = face_left_of(edge.second, edge.first);
    if (left == triangles_.size() || right == triangles_.size())
    {
        return false;
    }
    vertices = {
        third_corner(left, edge.first, edge.second), third_corner(right, edge.first, edge.second)};
    return true;
}

void EditableMesh::detach(std::uint32_t vertex, std::uint32_t face)
{
    auto& list = faces_[vertex];
    list.erase(std::find(list.begin(), list.end(), face));
}

void EditableMesh::replace_corner(std::uint32_t face, std::uint32_t from, std::uint32_t to)
{
    std::replace(triangles_[face].begin(), triangles_[face].end(), from, to);
    detach(from, face);
    faces_[to].push_back(face);
}

//        c                  c
//      /   \              / | \      .
//     a --- b     ->     a--m--b     the new faces are m b c and b m d
//      \   /              \ | /
//        d                  d
bool EditableMesh::split(const Edge& edge, const Vector3& position)
{
    Edge sides;
    if (!opposite(edge, sides))
    {
        return false;
    }
    const auto [a, b] = edge;
    const auto [c, d] = sides;
    const std::uint32_t left = face_left_of(a, b);
    const std::uint32_t right = face_left_of(b, a);
    const std::uint32_t middle = vertex_count();
    positions_.push_back(position);
    faces_.emplace_back();
    replace_corner(left, b, middle);
    replace_corner(right, b, middle);
    for (const Triangle& triangle : {Triangle{middle, b, c}, Triangle{b, middle, d}})
    {
        const auto face = static_cast<std::uint32_t>(triangles_.size());
        triangles_.push_back(triangle);
        for (const std::uint32_t vertex : triangle)
        {
            faces_[vertex].push_back(face);
        }
    }
    return true;
}

bool EditableMesh::turns_over(std::uint32_t vertex, std::uint32_t other, const Vector3& position)
    const
{
    for (const std::uint32_t face : faces_[vertex])
    {
        if (has_corner(triangles_[face], other))
        {
            continue;
        }
        std::array<Vector3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::uint32_t corner = triangles_[face][i];
            corners[i] = corner == vertex ? position : positions_[corner];
        }
        const Vector3 before = area_normal(face);
        const Vector3 after = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (!(dot(before, after) > kLeastCosine * length(before) * length(after)))
        {
            return true;
        }
    }
    return false;
}

bool EditableMesh::collapse(std::uint32_t kept, std::uint32_t removed, const Vector3& position)
{
    Edge sides;
    if (!opposite({kept, removed}, sides) || is_boundary(removed))
    {
        return false;
    }
    // Link condition: the ends share exactly the two vertices opposite the edge, and those keep at
    // least three faces.
    const auto near_kept = neighbours(kept);
    const auto near_removed = neighbours(removed);
    std::vector<std::uint32_t> shared;
    std::set_intersection(
        near_kept.begin(),
        near_kept.end(),
        near_removed.begin(),
        near_removed.end(),
        std::back_inserter(shared)
    );
    if (shared.size() != 2 || faces_[sides.first].size() <= 3 || faces_[sides.second].size() <= 3 ||
        turns_over(kept, removed, position) || turns_over(removed, kept, position))
    {
        return false;
    }
    const std::vector<std::uint32_t> star = faces_[removed];
    for (const std::uint32_t face : star)
    {
        if (!has_corner(triangles_[face], kept))
        {
            replace_corner(face, removed, kept);
            continue;
        }
        for (const std::uint32_t vertex : Triangle(triangles_[face]))
        {
            detach(vertex, face);
        }
        triangles_[face] = {kept, kept, kept};
    }
    positions_[kept] = position;
    return true;
}

//        c                c
//      /   \            / | \        .
//     a --- b    ->    a  |  b       faces a b c, b a d become a d c, d b c
//      \   /            \ | /
//        d                d
bool EditableMesh::flip(const Edge& edge)
{
    Edge sides;
    if (!opposite(edge, sides))
    {
        return false;
    }
    const auto [a, b] = edge;
    const auto [c, d] = sides;
    const std::uint32_t left = face_left_of(a, b);
    const std::uint32_t right = face_left_of(b, a);
    if (face_left_of(c, d) != triangles_.size() || face_left_of(d, c) != triangles_.size() ||
        faces_[a].size() <= 3 || faces_[b].size() <= 3)
    {
        return false;
    }
    const Vector3 before = unit(area_normal(left)) + unit(area_normal(right));
    const Vector3 one = cross(positions_[d] - positions_[a], positions_[c] - positions_[a]);
    const Vector3 two = cross(positions_[b] - positions_[d], positions_[c] - positions_[d]);
    const double least = kLeastCosine * length(before);
    if (!(dot(before, one) > least * length(one)) || !(dot(before, two) > least * length(two)))
    {
        return false;
    }
    replace_corner(left, b, d);
    replace_corner(right, a, c);
    return true;
}

IndexedMesh EditableMesh::compact() const
{
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    IndexedMesh mesh;
    std::vector<std::uint32_t> renamed(vertex_count(), kNone);
    for (const Triangle& triangle : triangles_)
    {
        if (triangle[0] == triangle[1])
        {
            continue;
        }
        Triangle result{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            std::uint32_t& name = renamed[triangle[i]];
            if (name == kNone)
            {
                name = static_cast<std::uint32_t>(mesh.positions.size());
                mesh.positions.push_back(to_array(positions_[triangle[i]]));
            }
            result[i] = name;
        }
        mesh.triangles.push_back(result);
    }
    return mesh;
}

}  // namespace vsplit::assets
