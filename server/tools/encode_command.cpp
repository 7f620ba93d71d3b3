#include "commands.h"
#include "core/file_io.h"
#include "encode_report.h"
#include "image/texture_layout.h"
#include "precompute/encode_model.h"
#include "precompute/keep_region.h"
#include "precompute/surface_io.h"
#include "progress_bar.h"
#include "report.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace vsplit::tools {
namespace {

/// What --drop calls the kinds of attributes.
constexpr std::array<std::pair<std::string_view, AttributeKind>, 4> kKinds{{
    {"uv", AttributeKind::TexCoord},
    {"normals", AttributeKind::Normal},
    {"colors", AttributeKind::Color},
    {"scalars", AttributeKind::Scalar},
}};

/// What it calls materials, groups and images.
constexpr std::string_view kMaterials = "materials";

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

/// Writes the names of the files that the input refers to, one a line; none that would look like two.
Result<void> list_companions(
    const EncodeArguments& arguments, const std::vector<std::string>& companions
)
{
    if (arguments.companions.empty())
    {
        return {};
    }
    std::string text;
    for (const std::string& name : companions)
    {
        text += name.find_first_of("\r\n") == name.npos ? name + "\n" : "";
    }
    return write_file_atomically(arguments.companions, std::as_bytes(std::span(text)));
}

/// Reads and repairs the input.
Result<void> load(const EncodeArguments& arguments, EncodeOutcome& outcome)
{
    Stopwatch watch;
    std::vector<std::string> companions;
    auto model = precompute::read_surface(arguments.input, companions);
    // Also when it failed: perhaps because one of them is missing.
    const auto listed = list_companions(arguments, companions);
    VSPLIT_TRY(model);
    VSPLIT_TRY(listed);
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
    outcome.dropped = std::move(model->dropped);
    outcome.dropped.insert(
        outcome.dropped.end(), repaired->dropped.begin(), repaired->dropped.end()
    );
    outcome.model = {std::move(*repaired), std::move(model->appearance), std::move(model->images)};
    outcome.seconds.repair = watch.lap();
    return {};
}

/// Encodes what load() left and writes the stream.
Result<void> encode(const EncodeArguments& arguments, bool speak, EncodeOutcome& outcome)
{
    Stopwatch watch;
    ProgressBar bar(speak);
    precompute::ModelOptions options = arguments.options;
    options.mesh.importance = std::move(outcome.model.surface.repaired.importance);
    auto encoded = precompute::encode_model(
        std::move(outcome.model),
        options,
        [&](std::string_view stage, double share) { bar.show(stage, share); }
    );
    if (!encoded)
    {
        return cannot_encode(arguments, encoded.error());
    }
    outcome.encoded = std::move(*encoded);
    outcome.seconds.encode = watch.lap();
    VSPLIT_TRY(write_file_atomically(arguments.output, outcome.encoded.mesh.file));
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
    arguments.options.mesh.metric = precompute::find_metric(arguments.metric).value();

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
void add_level_flags(CLI::App& command, precompute::EncodeOptions& options)
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

/// Adds what says what is told, and to whom.
void add_output_flags(CLI::App& command, EncodeArguments& arguments)
{
    command.add_option("--json", arguments.json, "Write JSON to a file, or to stdout with -");
    command.add_option(
        "--companions",
        arguments.companions,
        "Write the names of the files that IN refers to, one a line, to this file"
    );
    command.add_flag("--quiet", arguments.quiet, "Print nothing but errors");
}

/// Adds what says how attributes are coded.
void add_attribute_flags(CLI::App& command, EncodeArguments& arguments)
{
    const auto bits = [&](const char* name, std::uint8_t& value, const char* help) {
        command.add_option(name, value, help)
            ->check(CLI::Range(2, int{codec::kMaxAttributeBits}))
            ->capture_default_str();
    };
    command
        .add_option(
            "--uv-bits",
            arguments.options.bits.tex_coord,
            "Bits of a texture coordinate [automatic: 10, or within a sixth of a texel of images]"
        )
        ->check(CLI::Range(2, int{codec::kMaxAttributeBits}));
    bits(
        "--normal-bits",
        arguments.options.bits.normal,
        "Bits of each of the two numbers of a normal"
    );
    bits("--color-bits", arguments.options.bits.color, "Bits of a colour's channel");
    bits("--scalar-bits", arguments.options.bits.scalar, "Bits of any other number");
    auto& images = arguments.options.images;
    command
        .add_option(
            "--texture-size", images.max_size, "Longest side of images; larger ones are scaled down"
        )
        ->check(CLI::Range(16U, image::kMaxTextureSide))
        ->capture_default_str();
    command.add_option("--texture-quality", images.psnr, "Quality of images, decibels")
        ->check(CLI::Range(15.0, 80.0))
        ->capture_default_str();
    command.add_flag("--texture-lossless", images.lossless, "Code images exactly");
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

/// Adds what marks parts of the model that matter most.
void add_keep_options(CLI::App& command, EncodeArguments& arguments)
{
    command
        .add_option(
            "--keep-region",
            arguments.keep_regions,
            "Keep the vertices in this ball longest: X,Y,Z,R in model units; may be repeated"
        )
        ->type_name("X,Y,Z,R")
        ->allow_extra_args(false)
        ->check([](const std::string& text) {
            const auto sphere = precompute::parse_keep_sphere(text);
            return sphere ? std::string() : sphere.error().message;
        });
    command.add_option(
        "--keep-mask",
        arguments.keep_mask,
        "Keep vertices longest by a text file with one number, 0 .. 1, for each vertex of IN"
    );
}

}  // namespace

void add_encode_command(CLI::App& app, Result<void>& result)
{
    const auto arguments = std::make_shared<EncodeArguments>();
    precompute::EncodeOptions& options = arguments->options.mesh;
    options.threads = std::max(1U, std::thread::hardware_concurrency());
    arguments->metric = std::string(precompute::metric_name(options.metric));

    CLI::App* const command = app.add_subcommand("encode", "Encodes a mesh into a stream");
    command
        ->add_option(
            "IN", arguments->input, "The model: .glb, .gltf, .obj, .ply, .off, .stl or .om"
        )
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
    add_keep_options(*command, *arguments);
    constexpr unsigned kMostThreads = 256;
    add_level_flags(*command, options);
    add_attribute_flags(*command, *arguments);
    command->add_option("--threads", options.threads, "Worker threads; do not change the result")
        ->check(CLI::Range(1U, kMostThreads))
        ->capture_default_str();
    add_output_flags(*command, *arguments);
    command->callback([arguments, &result] { result = run(*arguments); });
}

}  // namespace vsplit::tools
