#include "precompute/level_errors.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <thread>

namespace vsplit::precompute {
namespace {

/// Samples that are enough for choosing a power of two.
constexpr std::size_t kCoarseSamples = 800;

constexpr std::size_t kFewestSamples = 2000;
constexpr std::size_t kMostSamples = 8000;

/// Tolerated ratio of cell size to surface error; larger saves bits, smaller shows steps. Measured: the
/// optimum between 3 and 4 is flat at every rate.
constexpr double kCellsPerError = 3.3;

/// Below this, in grid units, a region counts as exact: cells cannot get smaller.
constexpr double kLeastRegionError = 0.1;

using Position = std::array<float, 3>;

/// Runs `work(i)` for i = 0 .. count - 1 on several threads.
template <typename Work>
void for_each_parallel(std::size_t count, unsigned threads, const Work& work)
{
    std::atomic<std::size_t> next{0};
    const auto drain = [&] {
        for (std::size_t i = next++; i < count; i = next++)
        {
            work(i);
        }
    };
    std::vector<std::jthread> workers;
    for (unsigned t = 1; t < threads; ++t)
    {
        workers.emplace_back(drain);
    }
    drain();
}

Position to_float(const Vector3& point)
{
    return {
        static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}

/// A level's surface with only the vertices that it uses.
struct Surface
{
    std::vector<Position> positions;
    std::vector<Triangle> triangles;
};

template <typename PositionOf>
Surface make_surface(
    std::span<const Triangle> triangles, std::size_t vertex_count, const PositionOf& position_of
)
{
    constexpr std::uint32_t kUnused = 0xFFFFFFFF;
    std::vector<std::uint32_t> place(vertex_count, kUnused);
    Surface surface;
    surface.triangles.assign(triangles.begin(), triangles.end());
    for (Triangle& triangle : surface.triangles)
    {
        for (std::uint32_t& v : triangle)
        {
            if (place[v] == kUnused)
            {
                place[v] = static_cast<std::uint32_t>(surface.positions.size());
                surface.positions.push_back(position_of(v));
            }
            v = place[v];
        }
    }
    return surface;
}

/// The part of the source that the publisher wants to keep; nothing when there is none.
class Region
{
public:
    Region(
        std::span<const Position> source,
        std::span<const Triangle> triangles,
        std::span<const float> importance
    )
    {
        std::vector<Triangle> marked;
        for (const Triangle& triangle : triangles)
        {
            if (!importance.empty() && std::ranges::all_of(triangle, [&](std::uint32_t v) {
                    return importance[v] > 0.0F;
                }))
            {
                marked.push_back(triangle);
            }
        }
        if (!marked.empty())
        {
            samples_ = sample_surface(source, marked, kCoarseSamples);
        }
    }

    /// How far the region is from a level's surface, rms; nothing when there is no region.
    [[nodiscard]] std::optional<double> distance_to(const Surface& surface) const
    {
        if (samples_.empty())
        {
            return std::nullopt;
        }
        const ClosestPointTree tree(surface.positions, surface.triangles);
        double sum = 0.0;
        std::uint32_t hint = 0;
        for (const Position& point : samples_)
        {
            sum += static_cast<double>(tree.squared_distance(point, hint));
        }
        return std::sqrt(sum / static_cast<double>(samples_.size()));
    }

private:
    std::vector<Position> samples_;
};

int shift_for(double rms, int bits)
{
    const double cells = kCellsPerError * rms;
    if (!(cells >= 2.0))
    {
        return 0;
    }
    // Half of the bits stay, so that a small model's base does not fall into a few points.
    return std::min(static_cast<int>(std::floor(std::log2(cells))), bits / 2);
}

}  // namespace

std::vector<LevelError> measure_levels(
    std::span<const Vector3> exact,
    const GridMesh& mesh,
    std::span<const std::vector<Triangle>> levels,
    std::span<const float> importance,
    int bits,
    unsigned threads,
    const std::function<void(double)>& progress
)
{
    std::vector<Position> source(exact.size());
    std::ranges::transform(exact, source.begin(), to_float);
    const std::size_t samples = std::clamp(exact.size() / 4, kFewestSamples, kMostSamples);
    const DistanceReference coarse(source, mesh.triangles, std::min(kCoarseSamples, samples));
    const Region region(source, mesh.triangles, importance);
    const DistanceReference fine(source, mesh.triangles, samples);
    std::vector<LevelError> errors(levels.size());
    for_each_parallel(levels.size(), threads, [&](std::size_t i) {
        const Surface surface =
            make_surface(levels[i], source.size(), [&](std::uint32_t v) { return source[v]; });
        double rms = coarse.measure(surface.positions, surface.triangles).rms;
        if (const auto inside = region.distance_to(surface))
        {
            // Cells made for the whole would blur the region. Measured (cow, homer, rocker-arm): the
            // geometric mean takes up to 44 % off the region's error at a given rate and adds up to
            // 15 % to the rest's; the region's own error as the measure adds up to 30 % to it.
            rms = std::sqrt(rms * std::min(rms, std::max(*inside, kLeastRegionError)));
        }
        errors[i].shift = shift_for(rms, bits);
    });
    errors.back().shift = 0;
    for (std::size_t i = errors.size() - 1; i-- > 0;)
    {
        errors[i].shift = std::max(errors[i].shift, errors[i + 1].shift);
    }
    std::atomic<std::size_t> done{0};
    for_each_parallel(levels.size(), threads, [&](std::size_t i) {
        const QuantizationGrid unit{.origin = {}, .cell = 1.0, .bits = bits};
        const Surface surface = make_surface(levels[i], source.size(), [&](std::uint32_t v) {
            std::array<std::int32_t, 3> index = mesh.positions[v];
            for (std::int32_t& coordinate : index)
            {
                coordinate >>= errors[i].shift;
            }
            return to_float(dequantize(unit, index, errors[i].shift));
        });
        errors[i].distance = fine.measure(surface.positions, surface.triangles);
        if (progress)
        {
            progress(static_cast<double>(++done) / static_cast<double>(levels.size()));
        }
    });
    return errors;
}

}  // namespace vsplit::precompute
