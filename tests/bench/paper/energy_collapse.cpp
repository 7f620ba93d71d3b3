// Based on: Hoppe, "Progressive Meshes", 1996, section 4 (energy of distances and springs, edge collapses
// with the new vertex started at both ends and in the middle); Hoppe, DeRose, Duchamp, McDonald,
// Stuetzle, "Mesh Optimization", 1993 (least squares for fixed projections). We leave out scalar and
// discontinuity terms, which the models have no use for, and keep boundary vertices on the boundary.
#include "paper/edge_plan.h"
#include "paper/projection.h"
#include "paper/simplifiers.h"
#include "precompute/collapse_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

namespace vsplit::bench {
namespace {

using precompute::CollapseMesh;
using precompute::OneRing;

constexpr std::uint32_t kValenceLimit = 20;

/// No face may turn by more than this (cosine), as in vsplit's own collapses.
constexpr double kLeastCosine = 0.25;

class EnergyCollapser
{
public:
    explicit EnergyCollapser(const IndexedMesh& mesh)
        : mesh_(static_cast<std::uint32_t>(mesh.positions.size()), mesh.triangles),
          face_count_(mesh.triangles.size()),
          face_points_(mesh.triangles.size()),
          stamp_(mesh.positions.size(), 0)
    {
        scale_to_unit(mesh);
        square_.resize(points_.size(), 0.0);
        std::vector<std::uint8_t> placed(points_.size(), 0);
        for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        {
            for (const std::uint32_t v : mesh.triangles[f])
            {
                if (placed[v]++ == 0)
                {
                    face_points_[f].push_back(v);
                }
            }
            add_sample(f, mesh.triangles[f]);
        }
    }

    IndexedMesh run(std::size_t faces)
    {
        for (const std::uint32_t v : mesh_.vertices())
        {
            push_edges(v);
        }
        while (face_count_ > faces && !queue_.empty())
        {
            const Entry entry = queue_.top();
            queue_.pop();
            if (entry.stamp == stamp_[entry.removed] + stamp_[entry.kept] &&
                !mesh_.is_removed(entry.removed) && !mesh_.is_removed(entry.kept))
            {
                carry_out(entry);
            }
        }
        IndexedMesh result{positions_, mesh_.triangles()};
        for (Vector3& point : result.positions)
        {
            point = point * size_ + origin_;
        }
        return without_unused_vertices(result);
    }

private:
    struct Entry
    {
        double cost = 0.0;
        std::uint32_t removed = 0;
        std::uint32_t kept = 0;
        std::uint32_t stamp = 0;
        Vector3 place{};

        friend bool operator>(const Entry& a, const Entry& b) { return a.cost > b.cost; }
    };

    void scale_to_unit(const IndexedMesh& mesh)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [low, high] =
                std::ranges::minmax(mesh.positions, {}, [k](const auto& p) { return p[k]; });
            origin_[k] = low[k];
            size_ = std::max(size_, high[k] - low[k]);
        }
        for (const Vector3& point : mesh.positions)
        {
            positions_.push_back((point - origin_) * (1.0 / size_));
        }
        points_ = positions_;
    }

    /// Points on faces besides the vertices (Hoppe, section 4.2), here one in the middle of each.
    void add_sample(std::size_t face, const Triangle& triangle)
    {
        const auto& [a, b, c] = triangle;
        face_points_[face].push_back(static_cast<std::uint32_t>(points_.size()));
        points_.push_back((positions_[a] + positions_[b] + positions_[c]) * (1.0 / 3.0));
        square_.push_back(0.0);
    }

    void push_edges(std::uint32_t vertex)
    {
        OneRing ring;
        if (!mesh_.ring(vertex, ring))
        {
            return;
        }
        for (std::size_t i = 0; i < ring.size; ++i)
        {
            push(vertex, ring.vertex[i]);
            push(ring.vertex[i], vertex);
        }
    }

    /// Prices an edge; only one direction of an inner edge counts, the place is free anyhow.
    void push(std::uint32_t removed, std::uint32_t kept)
    {
        const bool same = mesh_.is_boundary(removed) == mesh_.is_boundary(kept);
        EdgePlan plan;
        if ((same && removed > kept) || !make_plan(removed, kept, plan))
        {
            return;
        }
        Entry best{std::numeric_limits<double>::infinity(), removed, kept, 0, {}};
        best.stamp = stamp_[removed] + stamp_[kept];
        const Vector3 middle = (positions_[removed] + positions_[kept]) * 0.5;
        for (const Vector3& start : {positions_[kept], positions_[removed], middle})
        {
            try_place(plan, start, best);
            if (!same)
            {
                break;  // the kept vertex stays on the boundary
            }
            if (!mesh_.is_boundary(removed))
            {
                try_place(plan, best_place(plan, start), best);
            }
        }
        if (std::isfinite(best.cost))
        {
            queue_.push(best);
        }
    }

    bool make_plan(std::uint32_t removed, std::uint32_t kept, EdgePlan& plan) const
    {
        OneRing other;
        plan.removed = removed;
        plan.kept = kept;
        if (!mesh_.ring(removed, plan.ring) || !mesh_.ring(kept, other))
        {
            return false;
        }
        const OneRing& ring = plan.ring;
        plan.ring_place = static_cast<std::size_t>(
            std::find(
                ring.vertex.begin(),
                ring.vertex.begin() + static_cast<std::ptrdiff_t>(ring.size),
                kept
            ) -
            ring.vertex.begin()
        );
        // CollapseMesh does not fold a corner that has one face.
        const bool at_end = plan.ring_place == 0 || plan.ring_place + 1 == ring.size;
        if (ring.size < 3 || (ring.boundary && !at_end) ||
            !mesh_.can_collapse(removed, ring, plan.ring_place, kValenceLimit))
        {
            return false;
        }
        add_faces(removed, ring, plan);
        add_faces(kept, other, plan);
        for (const OneRing* const around : {&ring, static_cast<const OneRing*>(&other)})
        {
            for (std::size_t i = 0; i < around->size; ++i)
            {
                const std::uint32_t v = around->vertex[i];
                if (v != removed && v != kept)
                {
                    plan.neighbours.push_back(positions_[v]);
                }
            }
        }
        const double density =
            static_cast<double>(plan.points.size()) / static_cast<double>(plan.before.size());
        plan.spring = density < 4.0 ? 1e-2 : density < 8.0 ? 1e-4 : 1e-8;
        return !plan.after.empty();
    }

    /// Adds the faces of a star: all of them, except those that the other star has.
    void add_faces(std::uint32_t centre, const OneRing& ring, EdgePlan& plan) const
    {
        for (std::size_t i = 0; i < ring.face_count; ++i)
        {
            const std::uint32_t a = ring.vertex[i];
            const std::uint32_t b = ring.vertex[(i + 1) % ring.size];
            const Face face{static_cast<std::size_t>(ring.corner[i] / 4), {centre, a, b}};
            const bool vanishes = a == plan.kept || b == plan.kept;
            if (centre == plan.kept && (a == plan.removed || b == plan.removed))
            {
                continue;  // shared with the removed vertex's star
            }
            plan.before.push_back(face);
            const auto& points = face_points_[face.slot];
            plan.points.insert(plan.points.end(), points.begin(), points.end());
            if (!vanishes)
            {
                plan.after.push_back({face.slot, {plan.kept, a, b}});
            }
        }
    }

    /// The corners of a face once the new vertex is in its place.
    [[nodiscard]] std::array<Vector3, 3> corners(const Face& face, const Vector3& place) const
    {
        // The new vertex comes first, see add_faces().
        return {place, positions_[face.corners[1]], positions_[face.corners[2]]};
    }

    [[nodiscard]] std::pair<std::size_t, Projection> closest(
        const EdgePlan& plan, const Vector3& place, const Vector3& point
    ) const
    {
        std::size_t best = 0;
        Projection nearest{std::numeric_limits<double>::infinity(), {}};
        for (std::size_t f = 0; f < plan.after.size(); ++f)
        {
            const Projection here = project(point, corners(plan.after[f], place));
            if (here.squared_distance < nearest.squared_distance)
            {
                nearest = here;
                best = f;
            }
        }
        return {best, nearest};
    }

    /// The place that is best while every point keeps its projection.
    [[nodiscard]] Vector3 best_place(const EdgePlan& plan, const Vector3& start) const
    {
        Vector3 sum{};
        double weight = 0.0;
        for (const std::uint32_t point : plan.points)
        {
            const auto [f, projection] = closest(plan, start, points_[point]);
            const auto& [own, second, third] = projection.weights;
            const auto triangle = corners(plan.after[f], start);
            const Vector3 rest = triangle[1] * second + triangle[2] * third;
            sum = sum + (points_[point] - rest) * own;
            weight += own * own;
        }
        for (const Vector3& neighbour : plan.neighbours)
        {
            sum = sum + neighbour * plan.spring;
            weight += plan.spring;
        }
        return sum * (1.0 / weight);
    }

    void try_place(const EdgePlan& plan, const Vector3& place, Entry& best) const
    {
        if (!is_sound(plan, place))
        {
            return;
        }
        double cost = 0.0;
        for (const std::uint32_t point : plan.points)
        {
            cost += closest(plan, place, points_[point]).second.squared_distance - square_[point];
        }
        double springs = 0.0;
        for (const Vector3& neighbour : plan.neighbours)
        {
            springs += dot(neighbour - place, neighbour - place);
        }
        cost += plan.spring * (springs - springs_before(plan));
        if (cost < best.cost)
        {
            best.cost = cost;
            best.place = place;
        }
    }

    [[nodiscard]] double springs_before(const EdgePlan& plan) const
    {
        const Vector3 edge = positions_[plan.removed] - positions_[plan.kept];
        double sum = dot(edge, edge);
        for (const Face& face : plan.before)
        {
            // Each inner spoke belongs to two faces; half of each counts.
            for (const std::size_t k : {1U, 2U})
            {
                const Vector3 spoke = positions_[face.corners[k]] - positions_[face.corners[0]];
                sum += 0.5 * dot(spoke, spoke);
            }
        }
        return sum;
    }

    [[nodiscard]] bool is_sound(const EdgePlan& plan, const Vector3& place) const
    {
        for (const Face& face : plan.after)
        {
            const auto [a, b, c] = corners(face, place);
            const auto old = std::ranges::find(plan.before, face.slot, &Face::slot);
            const Vector3& centre = positions_[old->corners[0]];
            const Vector3 was =
                cross(positions_[old->corners[1]] - centre, positions_[old->corners[2]] - centre);
            const Vector3 is = cross(b - a, c - a);
            if (!(dot(was, is) > kLeastCosine * std::sqrt(dot(was, was) * dot(is, is))))
            {
                return false;
            }
        }
        return true;
    }

    void carry_out(const Entry& entry)
    {
        EdgePlan plan;
        if (!make_plan(entry.removed, entry.kept, plan))
        {
            return;
        }
        for (const Face& face : plan.before)
        {
            face_points_[face.slot].clear();
        }
        for (const std::uint32_t point : plan.points)
        {
            const auto [f, projection] = closest(plan, entry.place, points_[point]);
            face_points_[plan.after[f].slot].push_back(point);
            square_[point] = projection.squared_distance;
        }
        mesh_.collapse(entry.removed, plan.ring, plan.ring_place);
        face_count_ -= plan.before.size() - plan.after.size();
        positions_[entry.kept] = entry.place;
        OneRing ring;
        if (!mesh_.ring(entry.kept, ring))
        {
            return;
        }
        ++stamp_[entry.kept];
        for (std::size_t i = 0; i < ring.size; ++i)
        {
            ++stamp_[ring.vertex[i]];
        }
        push_edges(entry.kept);
        for (std::size_t i = 0; i < ring.size; ++i)
        {
            push_edges(ring.vertex[i]);
        }
    }

    CollapseMesh mesh_;
    std::size_t face_count_;
    std::vector<std::vector<std::uint32_t>> face_points_;  ///< By face the points closest to it.
    std::vector<std::uint32_t> stamp_;  ///< By vertex how often its star has changed.
    std::vector<Vector3> positions_;    ///< Present vertices, in the unit cube.
    std::vector<Vector3> points_;       ///< The original vertices.
    std::vector<double> square_;        ///< By point its squared distance to the surface.
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
    Vector3 origin_{};
    double size_ = 1e-300;  ///< Longest side of the bounding box.
};

}  // namespace

IndexedMesh simplify_by_energy(const IndexedMesh& mesh, std::size_t faces)
{
    return EnergyCollapser(mesh).run(faces);
}

}  // namespace vsplit::bench
