#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit {

/// Finds the closest point of a triangle mesh; a bounding-volume hierarchy. Immutable once built, so
/// queries are thread safe.
class ClosestPointTree
{
public:
    /// Builds the tree. `positions`, `triangles`: a mesh, copied in single precision relative to its
    /// centre; degenerate triangles are fine. Precondition: at least one triangle.
    /// Cost: n log n with a small constant (bunny's 69 k triangles in about 10 ms).
    ClosestPointTree(
        std::span<const std::array<float, 3>> positions, std::span<const Triangle> triangles
    );

    /// Returns the squared distance from `point` to the mesh; `hint` is the triangle that was closest
    /// to a nearby point (any value), and receives the closest one, which makes coherent queries fast.
    [[nodiscard]] float squared_distance(const std::array<float, 3>& point, std::uint32_t& hint) const;

private:
    // implementation-defined members
};

/// A distance between two surfaces, model units.
struct SurfaceDistance
{
    double rms = 0.0;  ///< The larger of both directions' root mean square.
    double max = 0.0;  ///< The larger of both directions' largest sampled distance (Hausdorff).
};

/// Draws points on a mesh, stratified by area, the same for the same arguments on every machine.
/// `count`: how many. Result: `count` points. Source of the parametrisation: Osada, Funkhouser,
/// Chazelle, Dobkin, "Shape Distributions", 2002, section 3.
[[nodiscard]] std::vector<std::array<float, 3>> sample_surface(
    std::span<const std::array<float, 3>> positions,
    std::span<const Triangle> triangles,
    std::size_t count
);

/// A surface that many others are measured against: its tree and samples are made once.
class DistanceReference
{
public:
    /// Prepares the reference. `samples`: points drawn on each surface, per direction.
    DistanceReference(
        std::span<const std::array<float, 3>> positions,
        std::span<const Triangle> triangles,
        std::size_t samples
    );

    /// Measures another surface against the reference, both directions. Thread safe.
    [[nodiscard]] SurfaceDistance measure(
        std::span<const std::array<float, 3>> positions, std::span<const Triangle> triangles
    ) const;

private:
    // implementation-defined members
};

}  // namespace vsplit
