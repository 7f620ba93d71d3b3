#include "make_assets/implicit.h"
#include "make_assets/models.h"
#include "make_assets/remesh.h"

namespace vsplit::assets {

namespace {

// A ring in the xy plane with a pearl set on top of it.
double pearl_ring(const Vector3& p)
{
    const double ring = torus_distance(p, {}, {0, 0, 1}, 1.0, 0.24);
    const double pearl = length(p - Vector3{0, 1.32, 0}) - 0.36;
    return smooth_minimum(ring, pearl, 0.12);
}

// A ring in the xz plane through the other one's middle, its tube swelling twelve times a turn.
double beaded_ring(const Vector3& p)
{
    const Vector3 centre{1.0, 0, 0};
    const Vector3 offset = p - centre;
    const double out = std::sqrt(offset.x * offset.x + offset.z * offset.z);
    const double c = out > 1e-9 ? offset.x / out : 1.0;
    // cos(12 t) from cos(t): cos(3 t) = 4 c^3 - 3 c, then twice cos(2 t) = 2 c^2 - 1.
    const double c3 = c * (4.0 * c * c - 3.0);
    const double c6 = 2.0 * c3 * c3 - 1.0;
    const double c12 = 2.0 * c6 * c6 - 1.0;
    return torus_distance(p, centre, {0, 1, 0}, 1.0, 0.19 + 0.035 * c12);
}

void append(IndexedMesh& mesh, const IndexedMesh& other)
{
    const auto shift = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& [a, b, c] : other.triangles)
    {
        mesh.triangles.push_back({a + shift, b + shift, c + shift});
    }
}

IndexedMesh make_ring(const Field& field, const Vector3& low, const Vector3& high)
{
    const IndexedMesh raw = polygonise(field, {.low = low, .high = high, .cell = 0.05});
    return remesh(
        raw,
        surface_of(field, 0.002),
        {.chord_error = 0.0012, .shortest_edge = 0.02, .longest_edge = 0.15}
    );
}

}  // namespace

IndexedMesh make_pair()
{
    IndexedMesh mesh = make_ring(pearl_ring, {-1.5, -1.5, -0.6}, {1.5, 1.9, 0.6});
    append(mesh, make_ring(beaded_ring, {-0.5, -0.5, -1.5}, {2.5, 0.5, 1.5}));
    return mesh;
}

}  // namespace vsplit::assets
