#include "make_assets/implicit.h"
#include "make_assets/models.h"
#include "make_assets/remesh.h"

#include <algorithm>
#include <map>

namespace vsplit::assets {

namespace {

IndexedMesh make_starfish()
{
    // Unit vectors 72 degrees apart, as literals: sines differ between machines.
    const std::vector<Vector3> arms{
        {1.0, 0, 0},
        {0.30901699437494745, 0, 0.9510565162951535},
        {-0.8090169943749475, 0, 0.5877852522924731},
        {-0.8090169943749475, 0, -0.5877852522924731},
        {0.30901699437494745, 0, -0.9510565162951535},
    };
    const Vector3 up{0, 1, 0};
    std::vector<Part> parts{{{{{0, 0.02, 0}, 0.30}}, 0.1, up, 1.7}};
    for (const Vector3& arm : arms)
    {
        parts.push_back(
            {{{arm * 0.1, 0.24}, {arm * 0.5 + up * 0.02, 0.155}, {arm * 0.95 - up * 0.03, 0.075}},
             0.12,
             up,
             1.5}
        );
        parts.push_back({{{arm * 0.15 + up * 0.17, 0.035}, {arm * 0.7 + up * 0.085, 0.02}}, 0.05});
    }
    const Body starfish(parts);
    const IndexedMesh raw =
        polygonise(starfish, {.low = {-1.2, -0.4, -1.2}, .high = {1.2, 0.4, 1.2}, .cell = 0.04});
    return remesh(
        raw,
        surface_of(starfish, 0.002),
        {.chord_error = 0.0016, .shortest_edge = 0.03, .longest_edge = 0.12}
    );
}

Vector3 corner(const IndexedMesh& mesh, const Triangle& triangle, std::size_t i)
{
    return to_vector(mesh.positions[triangle[i]]);
}

Vector3 centre(const IndexedMesh& mesh, const Triangle& triangle)
{
    const Vector3 sum =
        corner(mesh, triangle, 0) + corner(mesh, triangle, 1) + corner(mesh, triangle, 2);
    return sum * (1.0 / 3.0);
}

Vector3 normal(const IndexedMesh& mesh, const Triangle& triangle)
{
    const Vector3 a = corner(mesh, triangle, 0);
    return unit(cross(corner(mesh, triangle, 1) - a, corner(mesh, triangle, 2) - a));
}

std::uint32_t add_vertex(IndexedMesh& mesh, const Vector3& position)
{
    mesh.positions.push_back(to_array(position));
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

// Gives the faces of one arm vertices of their own: a crack with equal positions on both sides.
void unweld_arm(IndexedMesh& mesh)
{
    std::map<std::uint32_t, std::uint32_t> outside;
    for (const Triangle& triangle : mesh.triangles)
    {
        if (centre(mesh, triangle).z <= 0.5)
        {
            for (const std::uint32_t vertex : triangle)
            {
                outside.emplace(vertex, vertex);
            }
        }
    }
    for (Triangle& triangle : mesh.triangles)
    {
        if (centre(mesh, triangle).z <= 0.5)
        {
            continue;
        }
        for (std::uint32_t& vertex : triangle)
        {
            const auto shared = outside.find(vertex);
            if (shared == outside.end())
            {
                continue;
            }
            if (shared->second == vertex)
            {
                shared->second = add_vertex(mesh, to_vector(mesh.positions[vertex]));
            }
            vertex = shared->second;
        }
    }
}

// The face whose centre is farthest along a direction.
std::size_t extreme_face(const IndexedMesh& mesh, const Vector3& direction)
{
    const auto found = std::max_element(
        mesh.triangles.begin(),
        mesh.triangles.end(),
        [&](const Triangle& a, const Triangle& b) {
            return dot(centre(mesh, a), direction) < dot(centre(mesh, b), direction);
        }
    );
    return static_cast<std::size_t>(found - mesh.triangles.begin());
}

}  // namespace

IndexedMesh make_dirty()
{
    IndexedMesh mesh = make_starfish();
    const Triangle top = mesh.triangles[extreme_face(mesh, {0.05, 1, 0.02})];
    const Triangle tip = mesh.triangles[extreme_face(mesh, {1, 0, 0})];
    // Inconsistent orientation: another arm is inside out.
    for (Triangle& triangle : mesh.triangles)
    {
        if (centre(mesh, triangle).z < -0.6)
        {
            std::swap(triangle[1], triangle[2]);
        }
    }
    unweld_arm(mesh);
    // A non-manifold edge: a fin stands on an edge of the top face.
    const Vector3 up = normal(mesh, top);
    const Vector3 middle = (corner(mesh, top, 0) + corner(mesh, top, 1)) * 0.5;
    mesh.triangles.push_back({top[0], top[1], add_vertex(mesh, middle + up * 0.08)});
    // A non-manifold vertex: a closed tetrahedron touches the tip of the first arm in one vertex.
    const Vector3 at = corner(mesh, tip, 0);
    const std::uint32_t a = add_vertex(mesh, at + Vector3{0.08, 0.04, 0.0});
    const std::uint32_t b = add_vertex(mesh, at + Vector3{0.08, -0.02, 0.04});
    const std::uint32_t c = add_vertex(mesh, at + Vector3{0.08, -0.02, -0.04});
    mesh.triangles.push_back({tip[0], b, a});
    mesh.triangles.push_back({tip[0], c, b});
    mesh.triangles.push_back({tip[0], a, c});
    mesh.triangles.push_back({a, b, c});
    // A face twice, once more turned round; a face that repeats a vertex; a vertex without a face.
    mesh.triangles.push_back(tip);
    mesh.triangles.push_back({top[1], top[0], top[2]});
    mesh.triangles.push_back({top[2], top[2], top[0]});
    add_vertex(mesh, {0.0, 0.6, 0.0});
    return mesh;
}

}  // namespace vsplit::assets
