#pragma once

#include "mesh/closest_point_tree.h"
#include "mesh/indexed_mesh.h"
#include "mesh/surface_distance.h"
#include "precompute/collapse_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// The surface that coarse ones are fitted to. Grid units.
struct FitSource
{
    std::vector<std::array<float, 3>> positions;
    std::span<const Triangle> triangles;
    std::vector<SurfaceSample> samples;  ///< Drawn evenly, as many as the largest fit needs.
    const ClosestPointTree* tree = nullptr;
};

/// A quadratic function of a step of one vertex: step . A step - 2 step . b, A symmetric.
struct QuadraticForm
{
    std::array<double, 6> matrix{};  ///< xx, xy, xz, yy, yz, zz.
    Vector3 linear{};
    double weight = 0.0;  ///< Samples that depend on the vertex, counted by how much.

    /// Takes the mean of this and another form.
    void average(const QuadraticForm& other);

    /// Adds `amount` times the squared distance from `to` along every direction.
    void attract(const Vector3& to, double amount);

    /// The value for a step.
    [[nodiscard]] double evaluate(const Vector3& step) const;

    /// The step of the least value; none where that is not unique.
    [[nodiscard]] Vector3 minimum() const;
};

/// A coarse surface whose vertices move to follow a source: points of either surface are tied to the
/// closest ones of the other, and every vertex sees how their squared distances change as it moves.
/// Not thread safe.
class SurfaceFit
{
public:
    /// Ties the surfaces together. `places`: coarse vertices, grid units; `triangles`: in them. `threads`: at
    /// least 1; the result does not depend on it.
    /// Cost: about a dozen searches for every vertex.
    SurfaceFit(
        const FitSource& source,
        std::vector<Vector3> places,
        std::span<const Triangle> triangles,
        unsigned threads
    );

    /// Samples of the source that a fit of `vertices` uses at least, when there are so many.
    [[nodiscard]] static std::size_t sample_count(std::size_t vertices);

    /// The sum of squared distances as a function of a step of one vertex, the others where they are.
    [[nodiscard]] QuadraticForm form(std::uint32_t vertex) const;

    /// Moves a vertex.
    void move(std::uint32_t vertex, const Vector3& step);

    /// Where a vertex is.
    [[nodiscard]] const Vector3& place(std::uint32_t vertex) const { return places_[vertex]; }

private:
    /// A point of the coarse surface and how far it should move. There are many.
    struct Tie
    {
        std::uint32_t face = 0;
        std::array<float, 3> share{};      ///< Of the face's vertices.
        std::array<float, 3> direction{};  ///< Of unit length.
        float importance = 1.0F;
        float distance = 0.0F;  ///< Along the direction, to the other surface.
    };

    /// A tie and the corner of its face that a vertex is: four times the tie plus the corner.
    using Use = std::uint32_t;

    void tie_source(const FitSource& source, unsigned threads);
    void tie_coarse(const FitSource& source, unsigned threads);
    void list_uses();
    [[nodiscard]] std::array<float, 3> corner(const Triangle& triangle, std::size_t k) const;

    std::vector<Vector3> places_;
    std::vector<Triangle> triangles_;
    std::vector<Tie> ties_;
    std::vector<std::uint32_t> first_use_;  ///< By vertex; one more at the end.
    std::vector<Use> uses_;
};

}  // namespace vsplit::precompute
