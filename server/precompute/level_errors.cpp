#include "precompute/level_errors.h"

#include <algorithm>
#include <atomic>
#include <cmath>
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
    int bits,
    unsigned threads,
    const std::function<void(double)>& progress
)
{
    std::vector<Position> source(exact.size());
    std::ranges::transform(exact, source.begin(), to_float);
    const std::size_t samples = std::clamp(exact.size() / 4, kFewestSamples, kMostSamples);
    const DistanceReference coarse(source, mesh.triangles, std::min(kCoarseSamples, samples));
    const DistanceReference fine(source, mesh.triangles, samples);
    std::vector<LevelError> errors(levels.size());
    for_each_parallel(levels.size(), threads, [&](std::size_t i) {
        const Surface surface =
            make_surface(levels[i], source.size(), [&](std::uint32_t v) { return source[v]; });
        errors[i].shift = shift_for(coarse.measure(surface.positions, surface.triangles).rms, bits);
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
