#pragma once

#include "codec/stream_encoder.h"
#include "mesh/closest_point_tree.h"
#include "mesh/indexed_mesh.h"
#include "mesh/surface_distance.h"
#include "precompute/collapse_mesh.h"
#include "precompute/fan_distance.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Measures how far a mesh moves away from its source while it is collapsed. Points on the source
/// carry the face that is closest to them along and look for another one only when it changes; points
/// on the coarse mesh, fewer, are searched for in the source.
/// Lengths are in grid units. Not thread safe.
class ErrorTracker
{
public:
    /// Starts with the complete mesh. `exact`: V source points, not rounded; `mesh`: the same on the
    /// grid; both must outlive the tracker. `importance`: V numbers, above 0 for the region that is
    /// watched, or empty. `threads`: at least 1; the results do not depend on it.
    /// Cost: one tree of the source.
    ErrorTracker(
        std::span<const Vector3> exact,
        const GridMesh& mesh,
        std::span<const float> importance,
        unsigned threads
    );

    /// Goes back to the complete mesh.
    void restart();

    /// Tree of the source.
    [[nodiscard]] const ClosestPointTree& tree() const { return tree_; }

    /// The coarse mesh's faces, in vertices of the source.
    [[nodiscard]] std::vector<Triangle> triangles() const;

    /// Carries out collapses that are possible now, the costliest one last.
    void collapse(std::span<const codec::Collapse> batch);

    /// Takes out whole components. What was nearest to them is nearest to something else from now on,
    /// wherever that is. Precondition: follow() since the last collapse. Cost: a tree of what is left.
    void remove_parts(std::span<const std::vector<Triangle>> parts);

    /// Root mean square distances from the source to the coarse mesh, positions not rounded.
    struct SourceError
    {
        double whole = 0.0;
        std::optional<double> region;  ///< Of the watched region, when there is one.
    };

    /// Follows the collapses since the last call and returns how far the source is off then.
    /// Cost: linear in the samples that moved.
    [[nodiscard]] SourceError follow();

    /// Measures the coarse mesh as it is shown. `cells`: by vertex its position on the grid without the
    /// lowest `shift` bits; the same as in the call before when the shift is the same.
    /// Precondition: follow(). Result: the larger of both directions; at least the true distance of
    /// the samples. Cost: linear in the samples that moved, or all when the shift changes, and one
    /// search in the tree for each sample of the other direction.
    [[nodiscard]] SurfaceDistance measure(
        int shift, std::span<const std::array<std::int32_t, 3>> cells
    );

private:
    /// A point on the source, and where it is closest to the coarse mesh.
    struct Sample
    {
        std::array<float, 3> point{};
        Triangle triangle{};       ///< The closest face's corners when it was found.
        std::uint32_t corner = 0;  ///< The one of them to search around.
        float square = 0.0F;       ///< Squared distance from the surface that is not rounded.
        float shown_square = 0.0F;
        bool moved = true;  ///< Since the last measure().
    };

    struct Sums
    {
        double mean_square = 0.0;
        double max_square = 0.0;
    };

    /// Faces with positions of their own.
    struct Shown
    {
        std::vector<std::array<float, 3>> positions;
        std::vector<Triangle> triangles;
    };

    void place_all_samples();
    void tie_anew(std::span<Sample> samples, const ClosestPointTree& tree) const;
    static Sums sum(std::span<const Sample> samples);
    [[nodiscard]] std::vector<Sample> place_samples(
        std::span<const Triangle> triangles, std::size_t count
    ) const;
    void follow(std::span<Sample> samples) const;
    void follow(Sample& sample) const;
    void update_shown(int shift);
    void search_all(int shift);
    [[nodiscard]] Sums measure_coarse(int shift) const;
    [[nodiscard]] Shown shown_faces(int shift, std::size_t step) const;
    [[nodiscard]] std::array<float, 3> shown(std::uint32_t vertex, int shift) const;
    [[nodiscard]] bool is_gone(const Triangle& triangle) const;
    [[nodiscard]] std::uint32_t survivor(std::uint32_t vertex) const;

    std::span<const Vector3> exact_;
    const GridMesh& source_;
    std::span<const float> importance_;
    unsigned threads_;
    CollapseMesh mesh_;
    std::vector<std::uint32_t> kept_of_;  ///< By removed vertex the one it was folded into.
    std::vector<std::uint32_t> faces_;    ///< Faces that are left.
    bool lacks_parts_ = false;            ///< Components were taken out.
    std::vector<Sample> samples_;
    std::vector<Sample> region_;    ///< On the watched region only.
    std::vector<Sample> vertices_;  ///< Removed vertices that are far off, for the maximum only.
    ClosestPointTree tree_;
    int shown_shift_ = -1;
    std::span<const std::array<std::int32_t, 3>> cells_;  ///< Of the call of measure() that runs.
};

}  // namespace vsplit::precompute
