#include "commands.h"
#include "decoded_model.h"
#include "heap_meter.h"
#include "precompute/surface_io.h"
#include "report.h"
#include "stream_file.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vsplit::tools {
namespace {

struct DecodeArguments
{
    std::string file;
    std::string output;
    std::string json;
    std::string error;
    std::optional<std::uint32_t> level;
    std::optional<std::uint64_t> bytes;
    std::optional<std::uint32_t> faces;
    std::uint32_t repeat = 1;
};

/// The mesh that a prefix shows, and what it took to decode it.
struct DecodeOutcome
{
    codec::StreamDecoder decoder;
    double median_seconds = 0.0;
    std::uint64_t heap_peak_bytes = 0;
};

/// Reads "--error": a length in model units, or a share of the diagonal when it ends in "%".
std::optional<double> parse_error(std::string text, double diagonal)
{
    const bool percent = text.ends_with('%');
    if (percent)
    {
        text.pop_back();
    }
    double value = 0.0;
    if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value) || value < 0.0)
    {
        return std::nullopt;
    }
    return percent ? value * diagonal / 100.0 : value;
}

/// Says how long a prefix of the stream the arguments ask for.
std::uint64_t wanted_prefix(const DecodeArguments& arguments, const codec::StreamInfo& info)
{
    codec::StopCondition stop;
    stop.level = arguments.level.value_or(stop.level);
    stop.bytes = arguments.bytes.value_or(stop.bytes);
    stop.faces = arguments.faces.value_or(stop.faces);
    stop.error = -1.0;  // no error is below it, whatever the mesh
    if (!arguments.error.empty())
    {
        stop.error = parse_error(arguments.error, info.diagonal()).value_or(stop.error);
    }
    return codec::stop_offset(info, stop);
}

Result<DecodeOutcome> decode(StreamFile& stream, std::uint64_t bytes, std::uint32_t repeat)
{
    std::vector<double> seconds;
    DecodeOutcome outcome;
    for (std::uint32_t round = 0; round < repeat; ++round)
    {
        outcome.decoder = codec::StreamDecoder();
        double elapsed = 0.0;
        const bool metered = round == 0;
        if (metered)
        {
            start_heap_meter();
            outcome.decoder = codec::StreamDecoder();
        }
        const auto decoded = stream.decode(outcome.decoder, bytes, elapsed);
        if (metered)
        {
            outcome.heap_peak_bytes = stop_heap_meter();
        }
        VSPLIT_TRY(decoded);
        seconds.push_back(elapsed);
    }
    std::sort(seconds.begin(), seconds.end());
    outcome.median_seconds = seconds[seconds.size() / 2];
    return outcome;
}

/// Decodes a prefix once more, with materials and images, and writes what it shows.
Result<void> write_model(StreamFile& stream, std::uint64_t bytes, const std::string& output)
{
    codec::StreamDecoder decoder;
    DecodedModel model;
    double seconds = 0.0;
    VSPLIT_TRY(stream.decode(decoder, bytes, seconds, [&](const codec::Step& step) {
        return model.take(step);
    }));
    const auto images = model.images();
    VSPLIT_TRY(images);
    const Surface surface = stitched_surface(decoder);
    return precompute::write_surface(
        output, precompute::view_model(surface, model.appearance(), *images)
    );
}

Json outcome_json(const DecodeOutcome& outcome)
{
    return {
        {"level", outcome.decoder.level()},
        {"vertices", outcome.decoder.vertices()},
        {"faces", outcome.decoder.faces()},
        {"bytes_used", outcome.decoder.decoded_bytes()},
        {"seconds", {{"decode", outcome.median_seconds}}},
        {"decoder_heap_peak_bytes", outcome.heap_peak_bytes},
    };
}

void print_outcome(const DecodeArguments& arguments, const DecodeOutcome& outcome)
{
    std::printf(
        "%s: level %u, %u vertices, %u faces from %llu bytes in %.3f ms\n",
        arguments.file.c_str(),
        outcome.decoder.level(),
        outcome.decoder.vertices(),
        outcome.decoder.faces(),
        static_cast<unsigned long long>(outcome.decoder.decoded_bytes()),
        outcome.median_seconds * 1e3
    );
    if (!arguments.output.empty())
    {
        std::printf("wrote %s\n", arguments.output.c_str());
    }
}

Result<void> run(const DecodeArguments& arguments)
{
    VSPLIT_TRY(check_not_same_file(arguments.file, arguments.output));
    auto stream = StreamFile::open(arguments.file);
    VSPLIT_TRY(stream);
    const auto present = stream->complete_prefix();
    VSPLIT_TRY(present);
    const std::uint64_t prefix = std::min(wanted_prefix(arguments, stream->info()), *present);
    const auto outcome = decode(*stream, prefix, arguments.repeat);
    VSPLIT_TRY(outcome);
    if (!arguments.output.empty())
    {
        VSPLIT_TRY(write_model(*stream, prefix, arguments.output));
    }
    if (arguments.json != "-")
    {
        print_outcome(arguments, *outcome);
    }
    return write_json(outcome_json(*outcome), arguments.json);
}

void check_usage(const DecodeArguments& arguments)
{
    if (arguments.output.empty() && arguments.json.empty())
    {
        throw CLI::RequiredError("-o or --json");
    }
}

}  // namespace

void add_decode_command(CLI::App& app, Result<void>& result)
{
    const auto arguments = std::make_shared<DecodeArguments>();
    CLI::App* const command =
        app.add_subcommand("decode", "Decodes a stream, or a prefix of it, into a mesh file");
    command->add_option("FILE", arguments->file, "The stream; it may be cut off")->required();
    command->add_option(
        "-o,--output", arguments->output, "The model: .glb, .obj, .ply, .off or .stl"
    );
    command->add_option("--json", arguments->json, "Write JSON to a file, or to stdout with -");
    constexpr std::uint32_t kMostRepeats = 100000;
    command->add_option("--repeat", arguments->repeat, "Decode so often and report the median")
        ->check(CLI::Range(1U, kMostRepeats));

    auto* const stop = command->add_option_group("stop", "Where to stop; the whole stream if none");
    stop->add_option("--level", arguments->level, "Stop at this level");
    stop->add_option("--bytes", arguments->bytes, "Read at most so many bytes");
    stop->add_option("--faces", arguments->faces, "Show at most so many faces");
    stop->add_option(
            "--error",
            arguments->error,
            "Stop at this RMS error, model units, or E% of the diagonal"
    )
        ->check([](const std::string& text) {
            return parse_error(text, 1.0) ? std::string()
                                          : "not a length nor a percentage: " + text;
        });
    stop->require_option(0, 1);
    command->callback([arguments, &result] {
        check_usage(*arguments);
        result = run(*arguments);
    });
}

}  // namespace vsplit::tools
