// Based on: Daubechies, DeVore, Fornasier, Gunturk, "Iteratively Reweighted Least Squares Minimization
// for Sparse Recovery", 2010: weights 1 / (scale + |residual|) make squares behave like magnitudes.
#include "codec/weight_fit.h"

#include "core/portable_log.h"

#include <algorithm>
#include <cmath>

namespace vsplit::codec {
namespace {

constexpr std::size_t kFewestSamples = 150;
constexpr double kWeightsCostBits = 60.0;

/// A small symmetric system with its right-hand side in the last column.
template <std::size_t N>
using System = std::array<std::array<double, N + 1>, N>;

template <std::size_t N>
std::array<double, N> solve(System<N> system)
{
    for (std::size_t i = 0; i < N; ++i)
    {
        system[i][i] = system[i][i] * 1.0001 + 1e-6;
    }
    for (std::size_t i = 0; i < N; ++i)
    {
        for (std::size_t j = i + 1; j < N; ++j)
        {
            const double factor = system[j][i] / system[i][i];
            for (std::size_t k = i; k <= N; ++k)
            {
                system[j][k] -= factor * system[i][k];
            }
        }
    }
    std::array<double, N> solution{};
    for (std::size_t i = N; i-- > 0;)
    {
        double sum = system[i][N];
        for (std::size_t k = i + 1; k < N; ++k)
        {
            sum -= system[i][k] * solution[k];
        }
        solution[i] = sum / system[i][i];
    }
    return solution;
}

Vector3 to_vector(const std::array<std::int32_t, 3>& position)
{
    return {
        static_cast<float>(position[0]),
        static_cast<float>(position[1]),
        static_cast<float>(position[2]),
    };
}

/// A residual split into its length along the normal and its length in the tangent plane.
struct Residual
{
    double normal = 0.0;
    double tangential = 0.0;
};

Residual residual_of(const FitSample& sample, const PredictionWeights& weights)
{
    const Vector3 off = to_vector(sample.position) - predict(sample.frame, weights);
    const float along = dot(off, sample.frame.normal);
    const Vector3 across = off - sample.frame.normal * along;
    return {along, std::sqrt(static_cast<double>(dot(across, across)))};
}

double estimated_bits(std::span<const FitSample> samples, const PredictionWeights& weights)
{
    double nats = 0.0;
    for (const FitSample& sample : samples)
    {
        const Residual residual = residual_of(sample, weights);
        // The tangential residual has two coordinates.
        const double tangential = 1.0 + 1.5 * residual.tangential;
        nats += portable_log((1.0 + 2.0 * std::fabs(residual.normal)) * (tangential * tangential));
    }
    return nats / kLn2;
}

std::int8_t to_weight(double value)
{
    const double scaled = std::floor(value * 64.0 + 0.5);
    return static_cast<std::int8_t>(
        std::isfinite(scaled) ? std::clamp(scaled, -127.0, 127.0) : 0.0
    );
}

PredictionWeights improve(std::span<const FitSample> samples, const PredictionWeights& weights)
{
    System<3> normal{};
    System<2> tangential{};
    for (const FitSample& sample : samples)
    {
        const RingFrame& frame = sample.frame;
        const Vector3 offset = to_vector(sample.position) - frame.centre;
        const float height = dot(offset, frame.normal);
        const Vector3 in_plane = offset - frame.normal * height;
        const Residual residual = residual_of(sample, weights);
        const double scale = static_cast<double>(frame.radius) + 2.0;
        const double normal_weight = 1.0 / (scale * 0.03 + std::fabs(residual.normal));
        const double tangential_weight = 1.0 / (scale * 0.1 + residual.tangential);
        const std::array<double, 4> heights{
            frame.heights[0], frame.heights[1], frame.heights[2], height};
        for (std::size_t i = 0; i < 3; ++i)
        {
            for (std::size_t j = 0; j < 4; ++j)
            {
                normal[i][j] += normal_weight * heights[i] * heights[j];
            }
        }
        const std::array<Vector3, 3> directions{frame.to_kept, frame.to_mean, in_plane};
        for (std::size_t i = 0; i < 2; ++i)
        {
            for (std::size_t j = 0; j < 3; ++j)
            {
                tangential[i][j] +=
                    tangential_weight * static_cast<double>(dot(directions[i], directions[j]));
            }
        }
    }
    const auto n = solve<3>(normal);
    const auto t = solve<2>(tangential);
    return {to_weight(n[0]), to_weight(n[1]), to_weight(n[2]), to_weight(t[0]), to_weight(t[1])};
}

}  // namespace

std::optional<PredictionWeights> fit_weights(
    std::span<const FitSample> samples, const PredictionWeights& current
)
{
    if (samples.size() < kFewestSamples)
    {
        return std::nullopt;
    }
    const PredictionWeights fitted = improve(samples, improve(samples, current));
    const double saving = estimated_bits(samples, current) - estimated_bits(samples, fitted);
    return saving > kWeightsCostBits ? std::optional(fitted) : std::nullopt;
}

}  // namespace vsplit::codec
