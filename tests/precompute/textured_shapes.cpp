#include "textured_shapes.h"

#include "codec/shapes.h"
#include "precompute/collapse_mesh.h"
#include "precompute/repair.h"

#include <deque>
#include <random>
#include <utility>

namespace vsplit::test {
namespace {

using precompute::CollapseMesh;
using precompute::OneRing;

/// Regions that grow round random faces until they meet.
std::vector<std::uint32_t> grow_charts(
    const CollapseMesh& linked, std::size_t faces, std::uint32_t charts, std::mt19937& random
)
{
    std::vector<std::uint32_t> groups(faces, charts);
    std::deque<std::pair<std::uint32_t, std::uint32_t>> front;
    for (std::uint32_t chart = 0; chart < charts; ++chart)
    {
        front.emplace_back(static_cast<std::uint32_t>(random() % faces), chart);
    }
    while (!front.empty())
    {
        const auto [face, chart] = front.front();
        front.pop_front();
        if (groups[face] != charts)
        {
            continue;
        }
        groups[face] = chart;
        for (std::int32_t k = 0; k < 3; ++k)
        {
            const std::int32_t across = linked.face_across(static_cast<std::int32_t>(4 * face) + k);
            if (across >= 0)
            {
                front.emplace_back(static_cast<std::uint32_t>(across), chart);
            }
        }
    }
    return groups;
}

}  // namespace

TexturedShape textured(
    const std::string& name,
    const IndexedMesh& mesh,
    std::uint32_t charts,
    double slits,
    unsigned seed
)
{
    std::mt19937 random(seed);
    TexturedShape shape;
    shape.name = name;
    shape.mesh = precompute::repair_mesh(mesh)->mesh;
    const auto count = static_cast<std::uint32_t>(shape.mesh.positions.size());
    const CollapseMesh linked(count, shape.mesh.triangles);
    shape.groups = grow_charts(linked, shape.mesh.triangles.size(), charts, random);
    std::vector<Triangle> values = shape.mesh.triangles;
    for (std::uint32_t v = 0; v < count; ++v)
    {
        OneRing ring;
        if (static_cast<double>(random() % 1000) >= 1000.0 * slits || !linked.ring(v, ring))
        {
            continue;
        }
        const std::size_t faces = 1 + random() % (ring.face_count - (ring.face_count > 1 ? 1 : 0));
        for (std::size_t i = 0; i < faces; ++i)
        {
            const auto corner = static_cast<std::size_t>(ring.corner[i]);
            values[corner >> 2][corner & 3] = count + v;
        }
    }
    const std::vector<std::span<const Triangle>> tables{values};
    shape.wedges = precompute::split_wedges(shape.mesh, tables, shape.groups);
    return shape;
}

std::vector<TexturedShape> textured_shapes()
{
    std::vector<TexturedShape> shapes;
    for (unsigned seed = 0; seed < 3; ++seed)
    {
        const IndexedMesh ring = torus(20, 12, 0.05, seed);
        const IndexedMesh ball = sphere(12, 13, 0.05, seed);
        const IndexedMesh sheet = height_field(16, 15, 0.4, seed);
        const IndexedMesh holes = with_holes(height_field(18, 15, 0.4, seed), 0.08, seed);
        shapes.push_back(textured("torus, 5 charts", ring, 5, 0.0, seed));
        shapes.push_back(textured("torus, slits", ring, 1, 0.05, seed));
        shapes.push_back(textured("sphere, 2 charts", ball, 2, 0.0, seed));
        shapes.push_back(textured("sphere, 12 charts and slits", ball, 12, 0.1, seed));
        shapes.push_back(textured("sheet, 6 charts", sheet, 6, 0.0, seed));
        shapes.push_back(textured("sheet, charts and slits", sheet, 3, 0.08, seed));
        shapes.push_back(textured("holes, charts and slits", holes, 8, 0.05, seed));
        shapes.push_back(textured("torus, every vertex split", ring, 4, 1.0, seed));
    }
    return shapes;
}

}  // namespace vsplit::test
