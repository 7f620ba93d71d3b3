#include "commands.h"
#include "core/file_io.h"
#include "precompute/code_attributes.h"
#include "precompute/encode_mesh.h"
#include "precompute/keep_region.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"
#include "progress_bar.h"
#include "report.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace vsplit::tools {
namespace {

using precompute::EncodedMesh;
using precompute::EncodeOptions;
using precompute::RepairedMesh;

/// What --drop calls the kinds of attributes.
constexpr std::array<std::pair<std::string_view, AttributeKind>, 4> kKinds{{
    {"uv", AttributeKind::TexCoord},
    {"normals", AttributeKind::Normal},
    {"colors", AttributeKind::Color},
    {"scalars", AttributeKind::Scalar},
}};

/// What it calls materials, groups and images.
constexpr std::string_view kMaterials = "materials";

struct EncodeArguments
{
    std::string input;
    std::string output;
    std::string metric;
    std::string json;
    std::vector<std::string> keep_regions;  ///< As they were written.
    std::string keep_mask;
    EncodeOptions options;
    precompute::AttributeBits bits;
    std::vector<std::string> drop;  ///< Names of kKinds, or "materials".
    bool attributes = true;
    bool quiet = false;
};

struct ToolSeconds
{
    double read = 0.0;
    double repair = 0.0;
    double encode = 0.0;
    double write = 0.0;
};

/// An encode, as far as it got.
struct EncodeOutcome
{
    std::size_t input_vertices = 0;
    std::size_t input_faces = 0;
    std::size_t kept_vertices = 0;  ///< Marked by --keep-region and --keep-mask.
    precompute::RepairedSurface surface;
    Appearance appearance;
    std::vector<SourceImage> images;
    std::vector<std::string> dropped;  ///< What the input has and the stream has not.
    EncodedMesh encoded;
    ToolSeconds seconds;
};

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
    const precompute::EncodeSeconds& stages = outcome.encoded.seconds;
    return {
        {"read", tool.read},
        {"repair", tool.repair},
        {"metric", stages.metric},
        {"collapse", stages.collapse},
        {"distance", stages.distance},
        {"code", stages.code},
        {"write", tool.write},
        {"total", tool.read + tool.repair + tool.encode + tool.write},
    };
}

Json outcome_json(const EncodeArguments& arguments, const EncodeOutcome& outcome)
{
    const codec::StreamInfo& info = outcome.encoded.info;
    return {
        {"input",
         {{"vertices", outcome.input_vertices},
          {"faces", outcome.input_faces},
          {"components", outcome.surface.repaired.components},
          {"boundary_edges", outcome.surface.repaired.boundary_edges}}},
        {"repair", repair_json(outcome.surface.repaired.report)},
        {"vertices", info.vertex_count},
        {"faces", info.face_count},
        {"position_bits", info.grid.bits},
        {"metric", arguments.metric},
        {"kept_vertices", outcome.kept_vertices},
        {"bytes", info.file_bytes},
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
    std::printf("repair: %s\n", repair_in_words(outcome.surface.repaired.report).c_str());
    std::printf(
        "encoding %zu vertices, %zu faces; components: %u, boundary edges: %u\n",
        outcome.surface.repaired.mesh.positions.size(),
        outcome.surface.repaired.mesh.triangles.size(),
        outcome.surface.repaired.components,
        outcome.surface.repaired.boundary_edges
    );
    if (outcome.kept_vertices > 0)
    {
        std::printf("kept for long: %zu vertices\n", outcome.kept_vertices);
    }
    std::fflush(stdout);
}

void print_outcome(const EncodeArguments& arguments, const EncodeOutcome& outcome)
{
    const codec::StreamInfo& info = outcome.encoded.info;
    print_levels(stdout, info);
    std::printf(
        "%s: %llu bytes, %.2f bits a vertex at %d bits a coordinate\n",
        arguments.output.c_str(),
        static_cast<unsigned long long>(info.file_bytes),
        bits_per_vertex(info, info.file_bytes),
        info.grid.bits
    );
    const ToolSeconds& tool = outcome.seconds;
    const precompute::EncodeSeconds& stages = outcome.encoded.seconds;
    std::printf(
        "seconds: read %.2f, repair %.2f, metric %.2f, collapse %.2f, distance %.2f, code %.2f, "
        "write %.2f, total %.2f\n",
        tool.read,
        tool.repair,
        stages.metric,
        stages.collapse,
        stages.distance,
        stages.code,
        tool.write,
        tool.read + tool.repair + tool.encode + tool.write
    );
}

/// Collects what --keep-region and --keep-mask mark: one number for each vertex, or none at all.
Result<std::vector<float>> find_importance(
    const EncodeArguments& arguments, const IndexedMesh& mesh
)
{
    std::vector<float> importance;
    if (!arguments.keep_mask.empty())
    {
        auto mask = precompute::read_keep_mask(arguments.keep_mask, mesh.positions.size());
        VSPLIT_TRY(mask);
        importance = std::move(*mask);
    }
    if (!arguments.keep_regions.empty())
    {
        importance.resize(mesh.positions.size(), 0.0F);
    }
    for (const std::string& region : arguments.keep_regions)
    {
        const auto sphere = precompute::parse_keep_sphere(region);
        VSPLIT_TRY(sphere);
        if (precompute::mark_sphere(mesh, *sphere, importance) == 0)
        {
            return fail(
                ErrorCode::UnsupportedInput,
                "--keep-region " + region + " holds no vertex of " + arguments.input
            );
        }
    }
    return importance;
}

/// Adds what is being done to an error.
tl::unexpected<Error> cannot_encode(const EncodeArguments& arguments, Error error)
{
    error.message = "cannot encode " + arguments.input + ": " + error.message;
    return tl::unexpected<Error>(std::move(error));
}

/// Takes out of a model what shall not be encoded.
void leave_out(const EncodeArguments& arguments, precompute::SourceModel& model)
{
    const auto dropped = [&](std::string_view name) {
        return !arguments.attributes ||
               std::ranges::find(arguments.drop, name) != arguments.drop.end();
    };
    std::erase_if(model.surface.attributes, [&](const SurfaceAttribute& attribute) {
        return std::ranges::any_of(kKinds, [&](const auto& kind) {
            return kind.second == attribute.kind && dropped(kind.first);
        });
    });
    if (dropped(kMaterials))
    {
        model.surface.groups.clear();
        model.appearance = {};
        model.images.clear();
    }
}

/// Reads and repairs the input.
Result<void> load(const EncodeArguments& arguments, EncodeOutcome& outcome)
{
    Stopwatch watch;
    auto model = precompute::read_surface(arguments.input);
    VSPLIT_TRY(model);
    outcome.seconds.read = watch.lap();
    outcome.input_vertices = model->surface.mesh.positions.size();
    outcome.input_faces = model->surface.mesh.triangles.size();
    const auto importance = find_importance(arguments, model->surface.mesh);
    VSPLIT_TRY(importance);
    outcome.kept_vertices = static_cast<std::size_t>(
        std::ranges::count_if(*importance, [](float value) { return value > 0.0F; })
    );
    leave_out(arguments, *model);
    auto repaired = precompute::repair_surface(model->surface, *importance);
    if (!repaired)
    {
        return cannot_encode(arguments, repaired.error());
    }
    outcome.surface = std::move(*repaired);
    outcome.appearance = std::move(model->appearance);
    outcome.images = std::move(model->images);
    outcome.dropped = std::move(model->dropped);
    outcome.dropped.insert(
        outcome.dropped.end(), outcome.surface.dropped.begin(), outcome.surface.dropped.end()
    );
    outcome.seconds.repair = watch.lap();
    return {};
}

/// Encodes what load() left and writes the stream.
Result<void> encode(const EncodeArguments& arguments, bool speak, EncodeOutcome& outcome)
{
    Stopwatch watch;
    ProgressBar bar(speak);
    EncodeOptions options = arguments.options;
    options.importance = std::move(outcome.surface.repaired.importance);
    auto input = precompute::make_encode_input(std::move(outcome.surface), arguments.bits);
    if (!input)
    {
        return cannot_encode(arguments, input.error());
    }
    auto encoded = precompute::encode_surface(
        std::move(*input),
        options,
        [&](std::string_view stage, double share) { bar.show(stage, share); }
    );
    if (!encoded)
    {
        return cannot_encode(arguments, encoded.error());
    }
    outcome.encoded = std::move(*encoded);
    outcome.seconds.encode = watch.lap();
    VSPLIT_TRY(write_file_atomically(arguments.output, outcome.encoded.file));
    outcome.seconds.write = watch.lap();
    return {};
}

Result<void> run(EncodeArguments arguments)
{
    if (arguments.output.empty())
    {
        arguments.output =
            std::filesystem::path(arguments.input).replace_extension(".vsplit").string();
    }
    VSPLIT_TRY(check_not_same_file(arguments.input, arguments.output));
    arguments.options.metric = precompute::find_metric(arguments.metric).value();

    const bool speak = !arguments.quiet && arguments.json != "-";
    EncodeOutcome outcome;
    VSPLIT_TRY(load(arguments, outcome));
    if (speak)
    {
        print_input(arguments, outcome);
    }
    VSPLIT_TRY(encode(arguments, !arguments.quiet, outcome));
    if (speak)
    {
        print_outcome(arguments, outcome);
    }
    return write_json(outcome_json(arguments, outcome), arguments.json);
}

std::vector<std::string> metric_names()
{
    std::vector<std::string> names;
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        names.emplace_back(name);
    }
    return names;
}

/// Adds what says how levels are coded.
void add_level_flags(CLI::App& command, EncodeOptions& options)
{
    command.add_flag(
        "--uncut{false}",
        options.cut_levels,
        "Give every level one chunk, however long; to see what cutting costs"
    );
    command.add_flag(
        "--splits-only{false}",
        options.grow_last_level,
        "Refine by splits to the end: larger files, but every chunk shows more"
    );
}

/// Adds what says how attributes are coded.
void add_attribute_flags(CLI::App& command, EncodeArguments& arguments)
{
    const auto bits = [&](const char* name, std::uint8_t& value, const char* help) {
        command.add_option(name, value, help)
            ->check(CLI::Range(2, int{codec::kMaxAttributeBits}))
            ->capture_default_str();
    };
    bits("--uv-bits", arguments.bits.tex_coord, "Bits of a texture coordinate");
    bits("--normal-bits", arguments.bits.normal, "Bits of each of the two numbers of a normal");
    bits("--color-bits", arguments.bits.color, "Bits of a colour's channel");
    bits("--scalar-bits", arguments.bits.scalar, "Bits of any other number");
    std::vector<std::string> names{std::string(kMaterials)};
    for (const auto& [name, kind] : kKinds)
    {
        names.emplace_back(name);
    }
    command
        .add_option(
            "--drop", arguments.drop, "Leave out some of: uv, normals, colors, scalars, materials"
        )
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(names));
    command.add_flag(
        "--no-attributes{false}", arguments.attributes, "Encode the shape and nothing else"
    );
}

}  // namespace

void add_encode_command(CLI::App& app, Result<void>& result)
{
    const auto arguments = std::make_shared<EncodeArguments>();
    EncodeOptions& options = arguments->options;
    options.threads = std::max(1U, std::thread::hardware_concurrency());
    arguments->metric = std::string(precompute::metric_name(options.metric));

    CLI::App* const command = app.add_subcommand("encode", "Encodes a mesh into a stream");
    command->add_option("IN", arguments->input, "The mesh: .obj, .ply, .off, .stl or .om")
        ->required();
    command->add_option("-o,--output", arguments->output, "The stream [IN with .vsplit]");
    command->add_option("--position-bits", options.position_bits, "Bits a coordinate")
        ->check(CLI::Range(proto::kMinPositionBits, proto::kMaxPositionBits))
        ->capture_default_str();
    command->add_option("--metric", arguments->metric, "What a collapse costs")
        ->check(CLI::IsMember(metric_names()))
        ->capture_default_str();
    command->add_option(
        "--base-vertices", options.base_vertices, "Vertices to aim for in the base mesh [automatic]"
    );
    command
        ->add_option(
            "--level-vertices",
            options.level_vertices,
            "Vertices that levels are to have exactly, e.g. 2000,500 [automatic]"
        )
        ->delimiter(',')
        ->allow_extra_args(false);
    command
        ->add_option(
            "--keep-region",
            arguments->keep_regions,
            "Keep the vertices in this ball longest: X,Y,Z,R in model units; may be repeated"
        )
        ->type_name("X,Y,Z,R")
        ->allow_extra_args(false)
        ->check([](const std::string& text) {
            const auto sphere = precompute::parse_keep_sphere(text);
            return sphere ? std::string() : sphere.error().message;
        });
    command->add_option(
        "--keep-mask",
        arguments->keep_mask,
        "Keep vertices longest by a text file with one number, 0 .. 1, for each vertex of IN"
    );
    constexpr unsigned kMostThreads = 256;
    add_level_flags(*command, options);
    add_attribute_flags(*command, *arguments);
    command->add_option("--threads", options.threads, "Worker threads; do not change the result")
        ->check(CLI::Range(1U, kMostThreads))
        ->capture_default_str();
    command->add_option("--json", arguments->json, "Write JSON to a file, or to stdout with -");
    command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
    command->callback([arguments, &result] { result = run(*arguments); });
}

}  // namespace vsplit::tools
