#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace vsplit::precompute {

/// What a half-edge collapse costs, hence in which order vertices go.
enum class Metric
{
    Curvature,         ///< Quadrics weighted with curvature from a least-squares quadric fit.
    CurvatureBspline,  ///< The same with curvature from the paper's bicubic B-spline fit.
    Quadrics,          ///< The same quadrics as Curvature, without its weight.
    Qem,               ///< Accumulated quadrics alone (Garland, Heckbert 1997).
    Normal,            ///< Normal deviation, the paper's "vector-based" comparison.
    EdgeLength,        ///< Squared edge length.
    Paper,             ///< The paper's own rule (Wang, Yang): feature points kept, equations 17-19.
};

/// All metrics with the names that the command line uses.
inline constexpr std::array<std::pair<Metric, std::string_view>, 7> kMetricNames{{
    {Metric::Curvature, "curvature"},
    {Metric::CurvatureBspline, "curvature-bspline"},
    {Metric::Quadrics, "quadrics"},
    {Metric::Qem, "qem"},
    {Metric::Normal, "normal"},
    {Metric::EdgeLength, "edge-length"},
    {Metric::Paper, "paper"},
}};

/// Returns a metric's command-line name.
[[nodiscard]] constexpr std::string_view metric_name(Metric metric)
{
    for (const auto& [value, name] : kMetricNames)
    {
        if (value == metric)
        {
            return name;
        }
    }
    return "unknown";
}

/// Finds a metric by its command-line name; nothing when there is none of that name.
[[nodiscard]] constexpr std::optional<Metric> find_metric(std::string_view name)
{
    for (const auto& [value, metric] : kMetricNames)
    {
        if (metric == name)
        {
            return value;
        }
    }
    return std::nullopt;
}

}  // namespace vsplit::precompute
