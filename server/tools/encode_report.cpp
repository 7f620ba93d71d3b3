#include "encode_report.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace vsplit::tools {
namespace {

/// Most memory that was resident at once. Not taken from getrusage(), which includes what the program
/// that started this one had resident before it became this one.
std::uint64_t peak_memory_bytes()
{
    constexpr std::string_view kField = "VmHWM:";
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
    {
        if (line.starts_with(kField))
        {
            return std::strtoull(line.c_str() + kField.size(), nullptr, 10) * 1024U;
        }
    }
    return 0;
}

Json seconds_json(const EncodeOutcome& outcome)
{
    const ToolSeconds& tool = outcome.seconds;
    const precompute::EncodeSeconds& stages = outcome.encoded.mesh.seconds;
    return {
        {"read", tool.read},
        {"repair", tool.repair},
        {"metric", stages.metric},
        {"collapse", stages.collapse},
        {"distance", stages.distance},
        {"code", stages.code},
        {"images", outcome.encoded.image_seconds},
        {"write", tool.write},
        {"total", tool.read + tool.repair + tool.encode + tool.write},
    };
}

}  // namespace

Json outcome_json(const EncodeArguments& arguments, const EncodeOutcome& outcome)
{
    const codec::StreamInfo& info = outcome.encoded.mesh.info;
    return {
        {"input",
         {{"vertices", outcome.input_vertices},
          {"faces", outcome.input_faces},
          {"components", outcome.model.surface.repaired.components},
          {"boundary_edges", outcome.model.surface.repaired.boundary_edges}}},
        {"repair", repair_json(outcome.model.surface.repaired.report)},
        {"vertices", info.vertex_count},
        {"faces", info.face_count},
        {"position_bits", info.grid.bits},
        {"metric", arguments.metric},
        {"kept_vertices", outcome.kept_vertices},
        {"bytes", info.file_bytes},
        {"image_bytes", outcome.encoded.image_bytes},
        {"attributes", attributes_json(info)},
        {"dropped", outcome.dropped},
        {"header_bytes", info.header_bytes},
        {"bits_per_vertex", bits_per_vertex(info, info.file_bytes)},
        {"base", base_json(info)},
        {"levels", levels_json(info)},
        {"seconds", seconds_json(outcome)},
        {"peak_memory_bytes", peak_memory_bytes()},
    };
}

void print_input(const EncodeArguments& arguments, const EncodeOutcome& outcome)
{
    std::printf(
        "%s: %zu vertices, %zu faces\n",
        arguments.input.c_str(),
        outcome.input_vertices,
        outcome.input_faces
    );
    std::printf("repair: %s\n", repair_in_words(outcome.model.surface.repaired.report).c_str());
    std::printf(
        "encoding %zu vertices, %zu faces; components: %u, boundary edges: %u\n",
        outcome.model.surface.repaired.mesh.positions.size(),
        outcome.model.surface.repaired.mesh.triangles.size(),
        outcome.model.surface.repaired.components,
        outcome.model.surface.repaired.boundary_edges
    );
    for (const std::string& note : outcome.dropped)
    {
        std::printf("left out: %s\n", note.c_str());
    }
    if (outcome.kept_vertices > 0)
    {
        std::printf("kept for long: %zu vertices\n", outcome.kept_vertices);
    }
    std::fflush(stdout);
}

void print_outcome(const EncodeArguments& arguments, const EncodeOutcome& outcome)
{
    const codec::StreamInfo& info = outcome.encoded.mesh.info;
    print_levels(stdout, info);
    std::printf(
        "%s: %llu bytes, %.2f bits a vertex at %d bits a coordinate\n",
        arguments.output.c_str(),
        static_cast<unsigned long long>(info.file_bytes),
        bits_per_vertex(info, info.file_bytes),
        info.grid.bits
    );
    const ToolSeconds& tool = outcome.seconds;
    const precompute::EncodeSeconds& stages = outcome.encoded.mesh.seconds;
    std::printf(
        "seconds: read %.2f, repair %.2f, metric %.2f, collapse %.2f, distance %.2f, code %.2f, "
        "images %.2f, write %.2f, total %.2f\n",
        tool.read,
        tool.repair,
        stages.metric,
        stages.collapse,
        stages.distance,
        stages.code,
        outcome.encoded.image_seconds,
        tool.write,
        tool.read + tool.repair + tool.encode + tool.write
    );
}

}  // namespace vsplit::tools
