#pragma once

#include "mesh/closest_point_tree.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit {

/// A distance between two surfaces, model units.
struct SurfaceDistance
{
    double rms = 0.0;  ///< The larger of both directions' root mean square.
    double max = 0.0;  ///< The larger of both directions' largest sampled distance (Hausdorff).
};

/// A point on a surface and the triangle that it was drawn on.
struct SurfaceSample
{
    std::array<float, 3> point{};
    std::uint32_t triangle = 0;

    friend bool operator==(const SurfaceSample&, const SurfaceSample&) = default;
};

/// Draws points on a mesh, stratified by area, the same for the same arguments on every machine, in an
/// order that keeps neighbours together (Morton order).
/// `positions`, `triangles`: a mesh with at least one triangle; `count`: how many.
/// Result: `count` samples. Cost: n log n in `count`. Thread safe.
/// Source of the parametrisation: Osada, Funkhouser, Chazelle, Dobkin, "Shape Distributions", 2002,
/// section 3.
[[nodiscard]] std::vector<SurfaceSample> sample_surface(
    std::span<const std::array<float, 3>> positions,
    std::span<const Triangle> triangles,
    std::size_t count
);

/// A surface that many others are measured against: its tree and samples are made once.
class DistanceReference
{
public:
    /// Prepares the reference. `positions`, `triangles`: a mesh with at least one triangle, copied;
    /// `samples`: points drawn on each surface, per direction, at least 1.
    DistanceReference(
        std::span<const std::array<float, 3>> positions,
        std::span<const Triangle> triangles,
        std::size_t samples
    );

    /// Measures another surface against the reference, both directions.
    /// `positions`, `triangles`: a mesh with at least one triangle. Result: model units; exact to about
    /// 1e-6 of the size (single precision), and to the sampling. Deterministic.
    /// Cost: one tree of the other mesh and 2 * samples queries. Thread safe.
    [[nodiscard]] SurfaceDistance measure(
        std::span<const std::array<float, 3>> positions, std::span<const Triangle> triangles
    ) const;

private:
    std::vector<SurfaceSample> samples_;
    ClosestPointTree tree_;
};

}  // namespace vsplit
