// Based on: Rossignac, Borrel, "Multi-resolution 3D Approximations for Rendering Complex Scenes", 1993
// (cells of a grid, the most important vertex stands for its cell); Low, Tan, "Model Simplification
// Using Vertex-Clustering", 1997 (cells around the most important vertices, importance by cos(t/2)).
#include "paper/simplifiers.h"
#include "paper/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace vsplit::bench {
namespace {

double length(const Vector3& a)
{
    return std::sqrt(dot(a, a));
}

/// Importance of every vertex: how likely it is on an outline, cos(t/2) with t the largest angle between
/// two of its edges (Low, Tan, section 3.1), times its longest edge (Rossignac, Borrel: large faces).
std::vector<double> grade_vertices(const IndexedMesh& mesh)
{
    std::vector<std::vector<Vector3>> edges(mesh.positions.size());
    for (const Triangle& triangle : mesh.triangles)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vector3& centre = mesh.positions[triangle[k]];
            edges[triangle[k]].push_back(mesh.positions[triangle[(k + 1) % 3]] - centre);
            edges[triangle[k]].push_back(mesh.positions[triangle[(k + 2) % 3]] - centre);
        }
    }
    std::vector<double> grades;
    for (const auto& around : edges)
    {
        double least_cosine = 1.0;
        double longest = 0.0;
        for (const Vector3& a : around)
        {
            longest = std::max(longest, length(a));
            for (const Vector3& b : around)
            {
                const double product = length(a) * length(b);
                least_cosine = std::min(least_cosine, product > 0.0 ? dot(a, b) / product : 1.0);
            }
        }
        // cos(t/2) from cos t.
        const double outline = std::sqrt(std::max(0.0, 0.5 * (1.0 + least_cosine)));
        grades.push_back(outline * longest);
    }
    return grades;
}

class Clusterer
{
public:
    Clusterer(const IndexedMesh& mesh, Clustering clustering)
        : mesh_(mesh), clustering_(clustering), order_(mesh.positions.size())
    {
        const auto grades = grade_vertices(mesh);
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        std::ranges::stable_sort(order_, [&](std::uint32_t a, std::uint32_t b) {
            return grades[a] > grades[b];
        });
        low_ = high_ = mesh.positions.front();
        for (const Vector3& point : mesh.positions)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                low_[k] = std::min(low_[k], point[k]);
                high_[k] = std::max(high_[k], point[k]);
            }
        }
    }

    [[nodiscard]] double extent() const { return length(high_ - low_); }

    /// The mesh that clusters of a size leave.
    [[nodiscard]] IndexedMesh cluster(double size) const
    {
        const auto leader =
            clustering_ == Clustering::Grid ? grid_leaders(size) : floating_leaders(size);
        IndexedMesh result{mesh_.positions, {}};
        std::set<std::array<std::uint32_t, 3>> known;
        for (const auto& [first, second, third] : mesh_.triangles)
        {
            const Triangle triangle{leader[first], leader[second], leader[third]};
            Triangle sorted = triangle;
            std::ranges::sort(sorted);
            if (sorted[0] != sorted[1] && sorted[1] != sorted[2] && known.insert(sorted).second)
            {
                result.triangles.push_back(triangle);
            }
        }
        return result;
    }

private:
    [[nodiscard]] std::vector<std::uint32_t> grid_leaders(double size) const
    {
        std::map<std::array<std::int64_t, 3>, std::uint32_t> cells;
        std::vector<std::uint32_t> leader(order_.size());
        for (const std::uint32_t v : order_)  // the most important one comes first
        {
            std::array<std::int64_t, 3> cell{};
            for (std::size_t k = 0; k < 3; ++k)
            {
                cell[k] = static_cast<std::int64_t>((mesh_.positions[v][k] - low_[k]) / size);
            }
            leader[v] = cells.try_emplace(cell, v).first->second;
        }
        return leader;
    }

    [[nodiscard]] std::vector<std::uint32_t> floating_leaders(double radius) const
    {
        std::vector<std::uint32_t> leader(order_.size());
        std::vector<double> nearest(order_.size(), std::numeric_limits<double>::infinity());
        for (const std::uint32_t centre : order_)
        {
            if (nearest[centre] <= radius)
            {
                continue;
            }
            for (std::uint32_t v = 0; v < nearest.size(); ++v)
            {
                // A vertex in several cells goes to the nearest centre (Low, Tan, section 3.3).
                const double distance = length(mesh_.positions[v] - mesh_.positions[centre]);
                if (distance <= radius && distance < nearest[v])
                {
                    nearest[v] = distance;
                    leader[v] = centre;
                }
            }
        }
        return leader;
    }

    const IndexedMesh& mesh_;
    Clustering clustering_;
    std::vector<std::uint32_t> order_;  ///< Vertices, the most important one first.
    Vector3 low_{};
    Vector3 high_{};
};

}  // namespace

IndexedMesh simplify_by_clustering(
    const IndexedMesh& mesh, Clustering clustering, std::size_t faces
)
{
    constexpr int kSteps = 24;
    if (mesh.triangles.size() <= faces)
    {
        return mesh;
    }
    const Clusterer clusterer(mesh, clustering);
    double small = 0.0;
    double large = 2.0 * clusterer.extent();
    IndexedMesh best;
    for (int step = 0; step < kSteps; ++step)
    {
        const double size = 0.5 * (small + large);
        IndexedMesh result = clusterer.cluster(size);
        const bool fits = result.triangles.size() <= faces;
        (fits ? large : small) = size;
        if (fits && result.triangles.size() >= best.triangles.size())
        {
            best = std::move(result);
        }
    }
    return without_unused_vertices(best);
}

}  // namespace vsplit::bench
