#include "precompute/level_schedule.h"

#include <algorithm>

namespace vsplit::precompute {
namespace {

/// Vertices of the base mesh to aim for: fewest; most where they fill the bytes of half a bit a vertex;
/// most where they fill a share of them.
constexpr double kFewestBaseVertices = 12.0;
constexpr double kSmallBaseVertices = 64.0;
constexpr double kMostBaseVertices = 128.0;
constexpr double kBaseShare = 0.6;

/// What header and index of a small mesh take, and a vertex of its base, bytes.
constexpr double kHeaderBytes = 105.0;
constexpr double kBaseVertexBytes = 2.4;

/// Share of the vertices down to which levels are built for small files rather than for low error: the
/// finest levels hold most of the vertices and hardly touch the picture at low rates.
constexpr double kRegularShare = 0.45;

/// Share of the vertices that a level below those removes: smaller follows the surface better, larger
/// costs less, because each level takes about nine bytes of its own.
constexpr double kCoarseShare = 0.2;

/// Share of the vertices, the cheapest, that it may choose among. With stars that must not overlap a
/// batch soon runs out of cheap ones, and one that should have stayed shows for the rest of the way.
constexpr double kCoarseChoice = 0.5;

/// Vertices that a batch removes at least, as far as there are so many.
constexpr std::size_t kSmallestBatch = 16;

bool is_made_for_coding(Metric metric)
{
    return metric == Metric::Curvature || metric == Metric::CurvatureBspline ||
           metric == Metric::Quadrics;
}

/// Vertices of the base to aim for: as many as half a bit a vertex has room for behind the header, so that
/// small meshes show something at low rates; to begin with more costs less than to begin with few.
std::size_t default_base(std::size_t vertices)
{
    const double bytes = static_cast<double>(vertices) / 16.0;
    const double fitting = std::clamp(
        (bytes - kHeaderBytes) / kBaseVertexBytes, kFewestBaseVertices, kSmallBaseVertices
    );
    const double ample = (bytes * kBaseShare - kHeaderBytes) / kBaseVertexBytes;
    return static_cast<std::size_t>(std::max(fitting, std::min(ample, kMostBaseVertices)));
}

}  // namespace

std::size_t next_stop(const EncodeOptions& options, std::size_t vertices, std::size_t all)
{
    std::size_t stop = options.base_vertices != 0 ? options.base_vertices : default_base(all);
    for (const std::uint32_t wanted : options.level_vertices)
    {
        if (wanted < vertices)
        {
            stop = std::max<std::size_t>(stop, wanted);
        }
    }
    return stop;
}

int late_bits(const EncodeOptions& options)
{
    return options.grow_last_level && options.level_vertices.empty() ? 0 : options.late_bits;
}

LevelStyle style_for(Metric metric, std::size_t vertices, std::size_t all)
{
    if (is_made_for_coding(metric) &&
        static_cast<double>(vertices) > kRegularShare * static_cast<double>(all))
    {
        return {
            .cost_weight = 1.0,
            .shape = 20.0,
            .centring = 10.0,
            .apex = 2.0,
            .packing = 2.0,
            .cheapest_share = 0.85,
            .largest_share = 1.0,
        };
    }
    LevelStyle style{.cheapest_share = kCoarseChoice, .largest_share = kCoarseShare};
    const double smallest = static_cast<double>(kSmallestBatch) / static_cast<double>(vertices);
    style.largest_share = std::max(style.largest_share, smallest);
    return style;
}

}  // namespace vsplit::precompute
