#include "report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <unistd.h>

namespace vsplit::client {
namespace {

using json = nlohmann::ordered_json;

// Three digits after the point are microseconds; more would be noise.
double round_to_micro(double value)
{
    return std::round(value * 1000.0) / 1000.0;
}

template <typename... Values>
std::string format(const char* pattern, Values... values)
{
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

json to_json(const LevelRow& row)
{
    const FrameTimes times = summarize(row.frame_ms);
    return {
        {"level", row.level},
        {"vertices", row.vertices},
        {"faces", row.faces},
        {"chunk_bytes", row.bytes.sum()},
        {"geometry_bytes", row.bytes.geometry},
        {"attribute_bytes", row.bytes.attributes},
        {"texture_bytes", row.bytes.textures},
        {"cumulative_bytes", row.cumulative_bytes},
        {"seconds", round_to_micro(row.seconds)},
        {"decode_ms", round_to_micro(row.decode_ms)},
        {"images", row.images},
        {"image_ms", round_to_micro(row.image_ms)},
        {"texture_memory_bytes", row.texture_memory_bytes},
        {"frames", row.frame_ms.size()},
        {"frame_ms_median", round_to_micro(times.median_ms)},
        {"frame_ms_p95", round_to_micro(times.p95_ms)},
        {"fps", round_to_micro(times.fps)},
        {"resident_bytes", row.resident_bytes},
    };
}

}  // namespace

double percentile(std::span<const double> samples, double share)
{
    if (samples.empty())
    {
        return 0.0;
    }
    std::vector<double> sorted(samples.begin(), samples.end());
    std::sort(sorted.begin(), sorted.end());
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    const double fraction = place - static_cast<double>(below);
    return sorted[below] + fraction * (sorted[above] - sorted[below]);
}

FrameTimes summarize(std::span<const double> frame_ms)
{
    const double total = std::accumulate(frame_ms.begin(), frame_ms.end(), 0.0);
    FrameTimes times{percentile(frame_ms, 0.5), percentile(frame_ms, 0.95), 0.0};
    if (total > 0.0)
    {
        times.fps = 1000.0 * static_cast<double>(frame_ms.size()) / total;
    }
    return times;
}

nlohmann::ordered_json to_json(const Report& report)
{
    json levels = json::array();
    LevelRow sum;
    for (const LevelRow& row : report.levels)
    {
        levels.push_back(to_json(row));
        sum.bytes += row.bytes;
        sum.images += row.images;
        sum.image_ms += row.image_ms;
    }
    return {
        {"model", report.model},
        {"device", report.device},
        {"link", report.link},
        {"memory",
         {
             {"cap_bytes", report.memory_cap_bytes},
             {"planned_bytes", report.memory_planned_bytes},
             {"texture_planned_bytes", report.texture_planned_bytes},
             {"texture_limit", report.texture_limit},
         }},
        {"levels", std::move(levels)},
        {"totals",
         {
             {"payload_bytes", report.transferred.payload_bytes},
             {"wire_bytes", report.transferred.wire_bytes},
             {"geometry_bytes", sum.bytes.geometry},
             {"attribute_bytes", sum.bytes.attributes},
             {"texture_bytes", sum.bytes.textures},
             {"images", sum.images},
             {"image_ms", round_to_micro(sum.image_ms)},
             {"seconds", round_to_micro(report.seconds)},
             {"reconnects", report.transferred.reconnects},
             {"complete", report.complete},
         }},
    };
}

std::string table_head(const Report& report)
{
    const std::string first =
        "level   vertices  triangles      bytes      total   seconds  decode  frames"
        "  median     p95     fps  memory";
    const std::string second =
        "                                                          s      ms"
        "              ms      ms             MB";
    return report.surface ? first + "  geometry  attribs  textures  images  decode  textures\n" +
                                second + "     bytes    bytes     bytes              ms        MB"
                          : first + "\n" + second;
}

std::string table_row(const Report& report, const LevelRow& row)
{
    const FrameTimes times = summarize(row.frame_ms);
    const std::string common = format(
        "%5u %10u %10u %10llu %10llu %9.3f %7.2f %7zu %7.2f %7.2f %7.1f %7.1f",
        row.level,
        row.vertices,
        row.faces,
        static_cast<unsigned long long>(row.bytes.sum()),
        static_cast<unsigned long long>(row.cumulative_bytes),
        row.seconds,
        row.decode_ms,
        row.frame_ms.size(),
        times.median_ms,
        times.p95_ms,
        times.fps,
        static_cast<double>(row.resident_bytes) / 1e6
    );
    if (!report.surface)
    {
        return common;
    }
    return common + format(
                        " %9llu %8llu %9llu %7zu %7.2f %9.2f",
                        static_cast<unsigned long long>(row.bytes.geometry),
                        static_cast<unsigned long long>(row.bytes.attributes),
                        static_cast<unsigned long long>(row.bytes.textures),
                        row.images,
                        row.image_ms,
                        static_cast<double>(row.texture_memory_bytes) / 1e6
                    );
}

std::string totals_line(const Report& report)
{
    const TransferCounters& sum = report.transferred;
    return format(
        "total: %llu bytes of stream, %llu bytes on the wire, %.3f s, %u reconnects",
        static_cast<unsigned long long>(sum.payload_bytes),
        static_cast<unsigned long long>(sum.wire_bytes),
        report.seconds,
        sum.reconnects
    );
}

std::uint64_t resident_bytes()
{
    // proc(5): the second number of statm is the resident set, in pages.
    std::ifstream statm("/proc/self/statm");
    std::uint64_t total_pages = 0;
    std::uint64_t resident_pages = 0;
    statm >> total_pages >> resident_pages;
    return statm ? resident_pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace vsplit::client
