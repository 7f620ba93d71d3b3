// Based on: Guéziec, Taubin, Lazarus, Horn, "Cutting and Stitching: Converting Sets of Polygons to
// Manifold Surfaces", 2001. Departure: they cut every edge with more than two faces and stitch what is
// edge to edge afterwards; here the faces of a smooth surface are never cut apart, if that gives a
// manifold, so that what stands on it costs it no copies.
#include "precompute/repair_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace vsplit::precompute {
namespace {

/// Cosine of the most that a surface turns across an edge where more than two faces meet.
constexpr double kLeastCosine = 0.0;

/// Faces of an edge among which pairs are looked for.
constexpr std::size_t kMostFaces = 16;

using Vector = std::array<double, 3>;

/// Unit normal of a face; zero when it has no area.
Vector unit_normal(const IndexedMesh& mesh, HalfEdge half)
{
    const Triangle& t = mesh.triangles[half / 3];
    const auto& a = mesh.positions[t[0]];
    const auto& b = mesh.positions[t[1]];
    const auto& c = mesh.positions[t[2]];
    const Vector u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Vector v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Vector n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return length > 0.0 ? Vector{n[0] / length, n[1] / length, n[2] / length} : Vector{};
}

/// Two faces at an edge that may go on in each other.
struct Pair
{
    double cosine = 0.0;  ///< Of the angle by which the surface turns.
    HalfEdge first = kNoHalfEdge;
    HalfEdge second = kNoHalfEdge;
};

/// Joins faces of an edge that has more than two, the smoothest first: those that turn the same way and
/// by less than a right angle. What is left over is cut off.
void join_smooth(
    const IndexedMesh& mesh, std::span<const HalfEdge> halves, std::vector<HalfEdge>& opposite
)
{
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < halves.size() && halves.size() <= kMostFaces; ++i)
    {
        const Vector normal = unit_normal(mesh, halves[i]);
        for (std::size_t j = i + 1; j < halves.size(); ++j)
        {
            const Vector other = unit_normal(mesh, halves[j]);
            const double cosine =
                normal[0] * other[0] + normal[1] * other[1] + normal[2] * other[2];
            const auto start = [&](HalfEdge half) { return mesh.triangles[half / 3][half % 3]; };
            if (cosine > kLeastCosine && start(halves[i]) != start(halves[j]))
            {
                pairs.push_back({cosine, halves[i], halves[j]});
            }
        }
    }
    std::ranges::stable_sort(pairs, std::greater<>(), &Pair::cosine);
    for (const auto& [cosine, first, second] : pairs)
    {
        if (opposite[first] == kNoHalfEdge && opposite[second] == kNoHalfEdge)
        {
            opposite[first] = second;
            opposite[second] = first;
        }
    }
}

/// The fans at both ends of an edge that a half-edge belongs to; the smaller one first.
std::array<std::uint32_t, 2> fans_of(const IndexedMesh& mesh, CornerFans& fans, HalfEdge half)
{
    const HalfEdge end = next_in_face(half);
    const bool turned = mesh.triangles[half / 3][half % 3] > mesh.triangles[end / 3][end % 3];
    return {fans.find(turned ? end : half), fans.find(turned ? half : end)};
}

/// Cuts pairs apart beside which another face of the edge comes to lie in the same fans at both ends: an
/// edge between two vertices would have three faces again. Result: true when there were some.
bool cut_conflicts(const IndexedMesh& mesh, const EdgeTable& edges, std::vector<HalfEdge>& opposite)
{
    CornerFans fans(opposite.size());
    for (HalfEdge half = 0; half < opposite.size(); ++half)
    {
        if (opposite[half] != kNoHalfEdge && half < opposite[half])
        {
            fans.link(mesh.triangles, half, opposite[half]);
        }
    }
    bool found = false;
    edges.for_each_edge([&](std::span<const HalfEdge> halves) {
        for (std::size_t i = 0; i < halves.size() && halves.size() > 2; ++i)
        {
            const HalfEdge half = halves[i];
            const HalfEdge partner = opposite[half];
            if (partner == kNoHalfEdge)
            {
                continue;
            }
            const auto own = fans_of(mesh, fans, half);
            const bool crowded = std::ranges::any_of(halves, [&](HalfEdge other) {
                return other != half && other != partner && fans_of(mesh, fans, other) == own;
            });
            if (crowded)
            {
                opposite[half] = kNoHalfEdge;
                opposite[partner] = kNoHalfEdge;
                found = true;
            }
        }
    });
    return found;
}

}  // namespace

std::vector<HalfEdge> join_edges(const IndexedMesh& mesh, RepairReport& report)
{
    std::vector<HalfEdge> opposite(3 * mesh.triangles.size(), kNoHalfEdge);
    const EdgeTable edges(mesh.triangles, mesh.positions.size());
    bool paired = false;
    edges.for_each_edge([&](std::span<const HalfEdge> halves) {
        if (halves.size() == 2)
        {
            opposite[halves[0]] = halves[1];
            opposite[halves[1]] = halves[0];
        }
        else if (halves.size() > 2)
        {
            ++report.non_manifold_edges;
            join_smooth(mesh, halves, opposite);
            paired = true;
        }
    });
    // Cuts only make fans smaller: what fits once fits for good, and this comes to an end.
    while (paired && cut_conflicts(mesh, edges, opposite))
    {
    }
    return opposite;
}

}  // namespace vsplit::precompute
