#include "report.h"

#include "core/file_io.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace vsplit::tools {
namespace {

double percent(const codec::StreamInfo& info, double error)
{
    const double diagonal = info.diagonal();
    return diagonal > 0.0 ? 100.0 * error / diagonal : 0.0;
}

/// The fields of a report with their JSON name and the words around their number.
struct RepairField
{
    std::uint32_t precompute::RepairReport::*count;
    const char* name;
    std::string_view before;
    std::string_view after;
};

using precompute::RepairReport;

constexpr std::array<RepairField, 8> kRepairFields{{
    {&RepairReport::welded_vertices, "welded_vertices", "welded ", " vertices at equal positions"},
    {&RepairReport::isolated_vertices, "isolated_vertices", "dropped ", " isolated vertices"},
    {&RepairReport::degenerate_faces, "degenerate_faces", "dropped ", " degenerate faces"},
    {&RepairReport::duplicate_faces, "duplicate_faces", "dropped ", " duplicate faces"},
    {&RepairReport::flipped_faces, "flipped_faces", "turned ", " faces round"},
    {&RepairReport::non_manifold_edges, "non_manifold_edges", "cut ", " non-manifold edges"},
    {&RepairReport::non_manifold_vertices, "non_manifold_vertices", "cut ", " vertices into fans"},
    {&RepairReport::added_vertices, "added_vertices", "added ", " copies of vertices"},
}};

}  // namespace

Result<void> write_json(const Json& json, const std::string& target)
{
    if (target.empty())
    {
        return {};
    }
    const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (target != "-")
    {
        return write_file_atomically(target, std::as_bytes(std::span(text)));
    }
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    return written ? Result<void>{} : fail(ErrorCode::IoError, "cannot write to standard output");
}

Json levels_json(const codec::StreamInfo& info)
{
    Json rows = Json::array();
    for (const codec::LevelInfo& level : info.levels)
    {
        rows.push_back({
            {"level", level.level},
            {"vertices", level.vertices},
            {"faces", level.faces},
            {"chunk_bytes", level.chunk_bytes},
            {"attribute_bytes", level.attribute_bytes},
            {"image_bytes", level.other_bytes},
            {"picture_psnr", level.picture_quality},
            {"cumulative_bytes", level.cumulative_bytes},
            {"rms_percent", percent(info, level.rms_error)},
            {"max_percent", percent(info, level.max_error)},
        });
    }
    return rows;
}

Json attributes_json(const codec::StreamInfo& info)
{
    constexpr std::array<const char*, 4> kNames{"uv", "normals", "colors", "scalars"};
    Json rows = Json::array();
    for (const codec::AttributeInfo& attribute : info.attributes)
    {
        rows.push_back({
            {"kind", kNames[static_cast<std::size_t>(attribute.kind)]},
            {"set", attribute.set},
            {"components", attribute.components},
            {"bits", attribute.bits},
            {"name", attribute.name},
        });
    }
    return rows;
}

Json base_json(const codec::StreamInfo& info)
{
    const codec::LevelInfo& base = info.levels.front();
    return {
        {"vertices", base.vertices}, {"faces", base.faces}, {"bytes", info.chunks.front().bytes}};
}

Json repair_json(const precompute::RepairReport& report)
{
    Json json = Json::object();
    for (const RepairField& field : kRepairFields)
    {
        json[field.name] = report.*field.count;
    }
    return json;
}

std::string repair_in_words(const precompute::RepairReport& report)
{
    std::string words;
    for (const RepairField& field : kRepairFields)
    {
        if (report.*field.count > 0)
        {
            words += (words.empty() ? "" : ", ") + std::string(field.before) +
                     std::to_string(report.*field.count) + std::string(field.after);
        }
    }
    return words.empty() ? "nothing to do" : words;
}

double bits_per_vertex(const codec::StreamInfo& info, std::uint64_t bytes)
{
    return 8.0 * static_cast<double>(bytes) / static_cast<double>(info.vertex_count);
}

void print_levels(std::FILE* out, const codec::StreamInfo& info)
{
    const bool more = std::ranges::any_of(info.levels, [](const codec::LevelInfo& level) {
        return level.attribute_bytes + level.other_bytes > 0;
    });
    std::fprintf(
        out,
        "%5s %10s %11s %10s %10s %9s %9s %8s%s\n",
        "level",
        "bytes",
        "cumulative",
        "vertices",
        "faces",
        "rms %",
        "max %",
        "bits/v",
        more ? " attributes     images picture dB" : ""
    );
    for (const codec::LevelInfo& level : info.levels)
    {
        std::fprintf(
            out,
            "%5u %10llu %11llu %10u %10u %9.4f %9.4f %8.2f",
            level.level,
            static_cast<unsigned long long>(level.chunk_bytes),
            static_cast<unsigned long long>(level.cumulative_bytes),
            level.vertices,
            level.faces,
            percent(info, level.rms_error),
            percent(info, level.max_error),
            bits_per_vertex(info, level.cumulative_bytes)
        );
        if (more)
        {
            std::fprintf(
                out,
                " %10llu %10llu %10.2f",
                static_cast<unsigned long long>(level.attribute_bytes),
                static_cast<unsigned long long>(level.other_bytes),
                level.picture_quality
            );
        }
        std::fputc('\n', out);
    }
}

Result<void> check_not_same_file(
    const std::filesystem::path& input, const std::filesystem::path& output
)
{
    std::error_code ignored;
    if (std::filesystem::equivalent(input, output, ignored))
    {
        return fail(ErrorCode::AlreadyExists, "the output " + output.string() + " is the input");
    }
    return {};
}

}  // namespace vsplit::tools
