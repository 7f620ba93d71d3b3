// Based on: Garland, Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997 (accumulated
// quadrics); Lindstrom, Turk, "Fast and Memory Efficient Polygonal Simplification", 1998 (quadrics of
// the present mesh, without memory); Wang, Yang, "3D Models Simplification Algorithm for Mobile
// Devices" (curvature as weight, feature points). Measured: the sum of both quadrics beats either, and
// curvature as a factor is neutral to good, while curvature alone as the order is far worse.
#include "precompute/collapse_cost.h"

#include "core/portable_log.h"
#include "precompute/curvature.h"

#include <algorithm>
#include <cmath>

namespace vsplit::precompute {
namespace {

/// Keeps prices apart on flat regions, where quadrics are all zero: shorter collapses first.
constexpr double kLengthTerm = 1e-7;

/// The paper folds low curvature into high; the other direction counts a thousand times.
constexpr double kWrongDirection = 1e3;

constexpr double kFeatureFactor = 1e6;

/// Price of a vertex that the publisher wants to keep, in prices of the same vertex unmarked, as a power
/// of 2. Measured with a tenth of cow, homer and rocker-arm marked, at 1 to 8 bits a vertex: 16 takes 40 %
/// off the region's error, 100 takes half off and adds a quarter to the rest's, 10^4 takes no more off and
/// leaves the rest with too few vertices (rocker-arm at 1 bit a vertex: three times its error).
constexpr double kKeepOctaves = 6.643856189774724;  // 100 times

double length(const Vector3& a)
{
    return std::sqrt(dot(a, a));
}

/// Adds the planes of a triangle, and of its boundary edges upright to it, to its vertices' quadrics.
void add_triangle(
    std::span<const Vector3> positions, const Triangle& triangle, std::vector<Quadric>& quadrics
)
{
    const Vector3& a = positions[triangle[0]];
    const Vector3 normal = cross(positions[triangle[1]] - a, positions[triangle[2]] - a);
    const double double_area = length(normal);
    if (!(double_area > 0.0))
    {
        return;
    }
    const Vector3 unit = normal * (1.0 / double_area);
    for (const std::uint32_t v : triangle)
    {
        quadrics[v].add_plane(unit, -dot(unit, a), double_area / 6.0);
    }
}

void add_boundary_edge(
    std::span<const Vector3> positions,
    const Triangle& triangle,
    std::size_t edge,
    std::vector<Quadric>& quadrics
)
{
    const std::uint32_t from = triangle[edge];
    const std::uint32_t to = triangle[(edge + 1) % 3];
    const Vector3 along = positions[to] - positions[from];
    const Vector3 normal = cross(
        positions[triangle[1]] - positions[triangle[0]],
        positions[triangle[2]] - positions[triangle[0]]
    );
    const Vector3 upright = cross(along, normal);
    const double size = length(upright);
    if (!(size > 0.0))
    {
        return;
    }
    const Vector3 unit = upright * (1.0 / size);
    const double weight = dot(along, along) * 0.5;
    quadrics[from].add_plane(unit, -dot(unit, positions[from]), weight);
    quadrics[to].add_plane(unit, -dot(unit, positions[from]), weight);
}

/// The value below which a share of the values lies.
float percentile(std::vector<float> values, double share)
{
    const auto index = std::min(
        values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size()))
    );
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(index));
    return values[index];
}

std::vector<float> curvature_factors(std::vector<float> curvature)
{
    double sum = 0.0;
    for (const float value : curvature)
    {
        sum += static_cast<double>(value);
    }
    const double mean = sum / static_cast<double>(curvature.size());
    const float most = percentile(curvature, 0.995);
    for (float& value : curvature)
    {
        const auto kept = static_cast<double>(std::min(value, most));
        value = mean > 0.0 ? static_cast<float>(1.0 + 0.5 * kept / mean) : 1.0F;
    }
    return curvature;
}

std::vector<float> paper_factors(const HalfEdgeMesh& mesh, unsigned threads)
{
    std::vector<float> curvature = bspline_curvature(mesh, threads);
    const auto feature = feature_points(mesh, curvature, {}, threads);
    const auto sparseness = sparseness_weights(mesh, threads);
    for (std::size_t v = 0; v < curvature.size(); ++v)
    {
        const double factor = feature[v] != 0 ? kFeatureFactor : 1.0;
        curvature[v] = static_cast<float>(
            static_cast<double>(curvature[v]) * static_cast<double>(sparseness[v]) * factor
        );
    }
    return curvature;
}

bool uses_quadrics(Metric metric)
{
    return metric == Metric::Curvature || metric == Metric::CurvatureBspline ||
           metric == Metric::Quadrics || metric == Metric::Qem;
}

std::vector<float> keep_factors(std::span<const float> importance)
{
    std::vector<float> factors;
    if (std::ranges::any_of(importance, [](float value) { return value > 0.0F; }))
    {
        factors.resize(importance.size());
        std::ranges::transform(importance, factors.begin(), [](float value) {
            return static_cast<float>(portable_exp2(kKeepOctaves * static_cast<double>(value)));
        });
    }
    return factors;
}

}  // namespace

void Quadric::add_plane(const Vector3& normal, double offset, double weight)
{
    const std::array<double, 4> plane{normal[0], normal[1], normal[2], offset};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        for (std::size_t j = i; j < 4; ++j)
        {
            coefficients_[k++] += weight * plane[i] * plane[j];
        }
    }
}

void Quadric::add(const Quadric& other)
{
    for (std::size_t i = 0; i < coefficients_.size(); ++i)
    {
        coefficients_[i] += other.coefficients_[i];
    }
}

double Quadric::evaluate(const Vector3& point) const
{
    const auto& [x, y, z] = point;
    const auto& c = coefficients_;
    return c[0] * x * x + 2.0 * c[1] * x * y + 2.0 * c[2] * x * z + 2.0 * c[3] * x + c[4] * y * y +
           2.0 * c[5] * y * z + 2.0 * c[6] * y + c[7] * z * z + 2.0 * c[8] * z + c[9];
}

CollapseCost::CollapseCost(
    Metric metric,
    std::span<const Vector3> positions,
    const CollapseMesh& mesh,
    std::vector<float> weights,
    std::span<const float> importance
)
    : metric_(metric),
      positions_(positions),
      weights_(std::move(weights)),
      keep_(keep_factors(importance))
{
    if (uses_quadrics(metric))
    {
        quadrics_.resize(positions.size());
        const std::vector<Triangle> triangles = mesh.triangles();
        for (std::size_t f = 0; f < triangles.size(); ++f)
        {
            add_triangle(positions, triangles[f], quadrics_);
            for (std::size_t edge = 0; edge < 3; ++edge)
            {
                const auto corner = static_cast<std::int32_t>(4 * f + (edge + 2) % 3);
                if (mesh.face_across(corner) < 0)
                {
                    add_boundary_edge(positions, triangles[f], edge, quadrics_);
                }
            }
        }
    }
}

StarGeometry CollapseCost::star(std::uint32_t vertex, const OneRing& ring) const
{
    StarGeometry star;
    const Vector3& centre = positions_[vertex];
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        star.offset[i] = positions_[ring.vertex[i]] - centre;
        star.mean = star.mean + star.offset[i];
    }
    star.mean = star.mean * (1.0 / static_cast<double>(ring.size));
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        star.area_normal[i] = cross(star.offset[i], star.offset[(i + 1) % ring.size]);
        star.double_area[i] = length(star.area_normal[i]);
        star.area += 0.5 * star.double_area[i];
    }
    return star;
}

double CollapseCost::quadric_price(
    std::uint32_t removed, const OneRing& ring, const StarGeometry& star, std::size_t kept
) const
{
    double price = std::max(0.0, quadrics_[removed].evaluate(positions_[ring.vertex[kept]]));
    if (metric_ != Metric::Qem)
    {
        double present = 0.0;
        for (std::size_t i = 0; i < ring.face_count; ++i)
        {
            if (star.double_area[i] > 0.0)
            {
                const double height = dot(star.area_normal[i], star.offset[kept]);
                present += height * height / star.double_area[i];
            }
        }
        // area / 3 * distance^2, with the area normal twice the area long.
        price += present / 6.0;
        price += attributes_ != nullptr ? attributes_->price(ring, star.offset, kept) : 0.0;
        // Times the root of the mean distance, so that what is far off counts more than its area.
        price *= star.area > 0.0 ? std::sqrt(std::sqrt(price / star.area)) : 1.0;
    }
    const double square = dot(star.offset[kept], star.offset[kept]);
    price += kLengthTerm * square * square + 1e-4 * star.area * square * 1e-3;
    return weights_.empty() ? price : price * static_cast<double>(weights_[removed]);
}

double CollapseCost::normal_price(const OneRing& ring, const StarGeometry& star, std::size_t kept)
    const
{
    double price = 0.0;
    for (std::size_t i = 0; i < ring.face_count; ++i)
    {
        const std::size_t j = (i + 1) % ring.size;
        if (i == kept || j == kept)
        {
            continue;
        }
        const Vector3 normal =
            cross(star.offset[i] - star.offset[kept], star.offset[j] - star.offset[kept]);
        const double product = star.double_area[i] * length(normal);
        const double cosine = product > 0.0 ? dot(star.area_normal[i], normal) / product : 1.0;
        price += star.double_area[i] * (1.0 - cosine);
    }
    return price + kLengthTerm * dot(star.offset[kept], star.offset[kept]);
}

double CollapseCost::price(
    std::uint32_t removed, const OneRing& ring, const StarGeometry& star, std::size_t kept
) const
{
    const double price = metric_price(removed, ring, star, kept);
    return keep_.empty() ? price : price * static_cast<double>(keep_[removed]);
}

double CollapseCost::metric_price(
    std::uint32_t removed, const OneRing& ring, const StarGeometry& star, std::size_t kept
) const
{
    switch (metric_)
    {
        case Metric::Curvature:
        case Metric::CurvatureBspline:
        case Metric::Quadrics:
        case Metric::Qem:
            return quadric_price(removed, ring, star, kept);
        case Metric::Normal:
            return normal_price(ring, star, kept);
        case Metric::EdgeLength:
            return dot(star.offset[kept], star.offset[kept]);
        case Metric::Paper:
            break;
    }
    const double own = static_cast<double>(weights_[removed]);
    const bool uphill = weights_[ring.vertex[kept]] >= weights_[removed];
    return (own + 1e-12 * dot(star.offset[kept], star.offset[kept])) *
           (uphill ? 1.0 : kWrongDirection);
}

void CollapseCost::merge(std::uint32_t removed, std::uint32_t kept)
{
    if (!quadrics_.empty())
    {
        quadrics_[kept].add(quadrics_[removed]);
    }
}

std::vector<float> vertex_weights(const HalfEdgeMesh& mesh, Metric metric, unsigned threads)
{
    switch (metric)
    {
        case Metric::Curvature:
            return curvature_factors(quadric_curvature(mesh, threads));
        case Metric::CurvatureBspline:
            return curvature_factors(bspline_curvature(mesh, threads));
        case Metric::Paper:
            return paper_factors(mesh, threads);
        case Metric::Quadrics:
        case Metric::Qem:
        case Metric::Normal:
        case Metric::EdgeLength:
            break;
    }
    return {};
}

}  // namespace vsplit::precompute
