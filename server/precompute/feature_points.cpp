// Based on: Wang, Yang, "3D Models Simplification Algorithm for Mobile Devices", equations 17-19.
// Our reading, for the paper's full text was not at hand: equation 17 compares a vertex with the mean
// over its adaptive neighbourhood; equations 18 and 19 build a weight from neighbour distances, which
// we take as the mean distance (18) in proportion to the whole model's mean (19).
#include "precompute/curvature.h"
#include "precompute/parallel_ranges.h"
#include "precompute/vertex_neighbourhood.h"

#include <algorithm>
#include <cmath>

namespace vsplit::precompute {

namespace {

double distance(const HalfEdgeMesh& mesh, std::uint32_t first, std::uint32_t second)
{
    const auto& a = mesh.point(vertex_handle(first));
    const auto& b = mesh.point(vertex_handle(second));
    const double x = a[0] - b[0];
    const double y = a[1] - b[1];
    const double z = a[2] - b[2];
    return std::sqrt(x * x + y * y + z * z);
}

double mean_of(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values)
    {
        sum += value;
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, values.size()));
}

/// Means of `value(vertex, neighbour)` over each vertex's adaptive neighbourhood; 0 where it is empty.
template <typename Value>
std::vector<double> neighbourhood_means(
    const HalfEdgeMesh& mesh, unsigned threads, const Value& value
)
{
    const auto vertex_count = static_cast<std::uint32_t>(mesh.n_vertices());
    std::vector<double> means(vertex_count, 0.0);
    parallel_ranges(vertex_count, threads, [&](std::uint32_t begin, std::uint32_t end) {
        NeighbourhoodSearch search(mesh);
        for (std::uint32_t v = begin; v < end; ++v)
        {
            const auto neighbours = search.adaptive(v);
            double sum = 0.0;
            for (const std::uint32_t neighbour : neighbours)
            {
                sum += value(v, neighbour);
            }
            means[v] = sum / static_cast<double>(std::max<std::size_t>(1, neighbours.size()));
        }
    });
    return means;
}

}  // namespace

std::vector<std::uint8_t> feature_points(
    const HalfEdgeMesh& mesh,
    const std::vector<float>& curvature,
    const FeatureOptions& options,
    unsigned threads
)
{
    const auto vertex_count = static_cast<std::uint32_t>(mesh.n_vertices());
    std::vector<std::uint8_t> features(vertex_count, 0);
    const double floor =
        options.flat * mean_of(std::vector<double>(curvature.begin(), curvature.end()));
    const auto means = neighbourhood_means(mesh, threads, [&](std::uint32_t, std::uint32_t other) {
        return static_cast<double>(curvature[other]);
    });
    for (std::uint32_t v = 0; v < vertex_count; ++v)
    {
        const auto own = static_cast<double>(curvature[v]);
        features[v] = own > options.ratio * means[v] && own > floor ? 1 : 0;  // eq. 17
    }
    return features;
}

std::vector<float> sparseness_weights(const HalfEdgeMesh& mesh, unsigned threads)
{
    const auto vertex_count = static_cast<std::uint32_t>(mesh.n_vertices());
    // eq. 18
    const auto spacing =
        neighbourhood_means(mesh, threads, [&](std::uint32_t v, std::uint32_t neighbour) {
            return distance(mesh, v, neighbour);
        });
    const double model_spacing = mean_of(spacing);
    std::vector<float> weights(vertex_count, 1.0F);
    if (!(model_spacing > 0.0) || !std::isfinite(model_spacing))
    {
        return weights;
    }
    // A vertex that coincides with all of its neighbours still gets a positive weight.
    constexpr double kLeastWeight = 1e-3;
    for (std::uint32_t v = 0; v < vertex_count; ++v)
    {
        weights[v] =
            static_cast<float>(std::max(kLeastWeight, spacing[v] / model_spacing));  // eq. 19
    }
    return weights;
}

}  // namespace vsplit::precompute
