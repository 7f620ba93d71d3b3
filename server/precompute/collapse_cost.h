#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/attribute_cost.h"
#include "precompute/collapse_mesh.h"
#include "precompute/half_edge_mesh.h"
#include "precompute/metric.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// A sum of squared distances to planes, as the ten coefficients of a symmetric 4 x 4 form.
/// Source: Garland, Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997, section 5.
class Quadric
{
public:
    /// Adds `weight` times the squared distance to the plane normal . x + offset = 0.
    /// Precondition: `normal` has unit length.
    void add_plane(const Vector3& normal, double offset, double weight);

    /// Adds another sum.
    void add(const Quadric& other);

    /// Evaluates the sum at a point; rounding can make it slightly negative.
    [[nodiscard]] double evaluate(const Vector3& point) const;

private:
    std::array<double, 10> coefficients_{};
};

/// The star of a vertex in coordinates relative to it, computed once for all its collapses.
struct StarGeometry
{
    std::array<Vector3, OneRing::kMost> offset{};       ///< Ring vertex - centre.
    std::array<Vector3, OneRing::kMost> area_normal{};  ///< Of face i, twice its area long.
    std::array<double, OneRing::kMost> double_area{};   ///< Of face i.
    Vector3 mean{};                                     ///< Mean of the offsets.
    double area = 0.0;                                  ///< Of the star.
};

/// Prices half-edge collapses by one of the metrics.
class CollapseCost
{
public:
    /// `positions`: V points in grid units, not rounded; `mesh`: the complete mesh, before any
    /// collapse, needed only during construction; `weights`: one factor a vertex for the metrics that
    /// use curvature (see vertex_weights()), empty for the others; `importance`: 0 .. 1 a vertex, 1
    /// for what the publisher wants to keep, or empty. Removing a vertex of importance w costs
    /// 100^w times as much.
    CollapseCost(
        Metric metric,
        std::span<const Vector3> positions,
        const CollapseMesh& mesh,
        std::vector<float> weights,
        std::span<const float> importance = {}
    );

    /// From now on metrics that use quadrics also count what lies on the surface. `attributes` must
    /// outlive this.
    void count_attributes(const AttributeCost& attributes)
    {
        attributes_ = attributes.empty() ? nullptr : &attributes;
    }

    /// Collects the star of a vertex.
    [[nodiscard]] StarGeometry star(std::uint32_t vertex, const OneRing& ring) const;

    /// Price of folding `removed` into neighbour number `kept`: never negative, comparable within a
    /// level.
    [[nodiscard]] double price(
        std::uint32_t removed, const OneRing& ring, const StarGeometry& star, std::size_t kept
    ) const;

    /// True when the publisher wants to keep a vertex for longer than its price says.
    [[nodiscard]] bool is_marked(std::uint32_t vertex) const
    {
        return !keep_.empty() && keep_[vertex] > 1.0F;
    }

    /// True when there is such a vertex.
    [[nodiscard]] bool has_marks() const { return !keep_.empty(); }

    /// Hands the removed vertex's share of the original surface to the kept one.
    void merge(std::uint32_t removed, std::uint32_t kept);

private:
    [[nodiscard]] double metric_price(
        std::uint32_t removed, const OneRing& ring, const StarGeometry& star, std::size_t kept
    ) const;
    [[nodiscard]] double quadric_price(
        std::uint32_t removed, const OneRing& ring, const StarGeometry& star, std::size_t kept
    ) const;
    [[nodiscard]] double normal_price(
        const OneRing& ring, const StarGeometry& star, std::size_t kept
    ) const;

    Metric metric_;
    std::span<const Vector3> positions_;
    std::vector<Quadric> quadrics_;
    std::vector<float> weights_;
    const AttributeCost* attributes_ = nullptr;  ///< None: only the shape has a price.
    std::vector<float> keep_;  ///< Factor of every vertex; empty when none is marked.
};

/// Computes the factors that a metric needs: for the curvature metrics 1 + C / (2 mean C), with C cut
/// off at its 99.5th percentile; for the paper's own rule C times the sparseness weight, feature points
/// counted a million times; nothing for the others.
/// `mesh`: from make_half_edge_mesh(), model units; `threads`: at least 1; the result does not depend
/// on it. Cost: that of the curvature.
/// Source: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", equations 17-19.
[[nodiscard]] std::vector<float> vertex_weights(
    const HalfEdgeMesh& mesh, Metric metric, unsigned threads
);

}  // namespace vsplit::precompute
