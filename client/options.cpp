#include "options.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace vsplit::client {
namespace {

constexpr int kUsageStatus = 2;
constexpr double kMostSeconds = 86400.0;

// What CLI11 fills before it is checked further.
struct RawOptions
{
    std::string address;
    std::string device = "pda";
    std::string link = "none";
    std::string error;
    std::string up = "y";
    double timeout_seconds = 30.0;
    bool no_render = false;
    bool no_attributes = false;
    std::optional<std::uint32_t> texture_limit;
};

void declare(CLI::App& app, RawOptions& raw, Options& options)
{
    codec::StopCondition& stop = options.stop.condition;
    app.add_option("model", raw.address, "HOST:PORT/NAME, NAME may contain folders")->required();
    app.add_option("--device", raw.device, "pda, phone, tablet or a JSON file")
        ->capture_default_str();
    app.add_option(
           "--link", raw.link, "none, modem28, gprs, edge, 3g, 4g, wifi or KBITS:LATENCY_MS"
    )
        ->capture_default_str();
    app.add_option("--frames", options.frames, "Least frames drawn per level")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_flag("--wireframe", options.wireframe, "Draw the edges of the mesh");
    app.add_flag(
        "--no-attributes", raw.no_attributes, "Leave out colours, normals, materials and textures"
    );
    app.add_option(
           "--texture-limit",
           raw.texture_limit,
           "Longest side of a texture, pixels; 0 for none; the device's by default"
    )
        ->check(CLI::Range(0, 32768));
    app.add_flag("--no-render", raw.no_render, "Decode only, draw nothing");
    app.add_option("--up", raw.up, "Axis of the model that points up")
        ->check(CLI::IsMember({"x", "y", "z"}))
        ->capture_default_str();
    app.add_option(
        "--screenshots", options.screenshots, "Write level-000.png ... into this folder"
    );
    app.add_option("--save", options.save, "Write the final mesh as PLY");
    app.add_option("--json", options.json, "Write the report as JSON; - is standard output");
    app.add_option("--level", stop.level, "Stop at this level; 0 is the base mesh");
    app.add_option("--bytes", stop.bytes, "Read at most so many bytes of the stream");
    app.add_option("--faces", stop.faces, "Stop before the mesh has more triangles");
    app.add_option(
        "--error", raw.error, "Stop at this RMS error: model units, or N% of the diagonal"
    );
    app.add_option("--timeout", raw.timeout_seconds, "Seconds of silence that end a connection")
        ->check(CLI::Range(0.01, kMostSeconds))
        ->capture_default_str();
    app.add_option("--retries", options.retries, "Attempts in a row to reconnect; 0 for none")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
}

Result<void> read_error_stop(const std::string& text, StopPlan& stop)
{
    if (text.empty())
    {
        return {};
    }
    stop.error_in_percent = text.ends_with('%');
    const std::string number = stop.error_in_percent ? text.substr(0, text.size() - 1) : text;
    double value = 0.0;
    if (!CLI::detail::lexical_cast(number, value) || !std::isfinite(value) || value < 0.0)
    {
        return fail(
            ErrorCode::BadRequest, "--error " + text + " is not a number such as 0.5 or 0.1%"
        );
    }
    if (value > 0.0)
    {
        stop.condition.error = value;  // Without any error is the end of the stream, not a stop.
    }
    return {};
}

Result<void> check(const RawOptions& raw, Options& options)
{
    auto address = parse_address(raw.address);
    VSPLIT_TRY(address);
    auto link = parse_link(raw.link);
    VSPLIT_TRY(link);
    auto device = load_device(raw.device);
    VSPLIT_TRY(device);
    VSPLIT_TRY(read_error_stop(raw.error, options.stop));
    options.address = std::move(*address);
    options.link = std::move(*link);
    options.device = std::move(*device);
    options.up = raw.up == "x" ? UpAxis::X : raw.up == "z" ? UpAxis::Z : UpAxis::Y;
    options.render = !raw.no_render;
    options.attributes = !raw.no_attributes;
    options.device.texture_limit = raw.texture_limit.value_or(options.device.texture_limit);
    options.timeout =
        std::chrono::milliseconds(static_cast<std::int64_t>(raw.timeout_seconds * 1000.0));
    if (!options.render && (options.wireframe || !options.screenshots.empty()))
    {
        return fail(
            ErrorCode::BadRequest,
            "--no-render draws nothing: leave --wireframe and --screenshots out"
        );
    }
    return {};
}

}  // namespace

std::variant<Options, EarlyExit> parse_options(int argc, const char* const* argv)
{
    CLI::App app("Simulated PDA: fetches a vsplit stream, refines it and draws every level.");
    app.name("vsplit-pda");
    app.set_version_flag("--version", std::string("vsplit-pda ") + VSPLIT_VERSION);
    RawOptions raw;
    Options options;
    declare(app, raw, options);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        std::ostringstream out;
        std::ostringstream complaint;
        const bool asked = app.exit(error, out, complaint) == 0;
        return asked ? EarlyExit{0, out.str()}
                     : EarlyExit{kUsageStatus, std::string("vsplit-pda: ") + error.what() + "\n"};
    }
    if (const auto checked = check(raw, options); !checked)
    {
        const Error& error = checked.error();
        const int status = exit_status(error.code);
        const bool unreadable = status == exit_status(ErrorCode::IoError);
        return EarlyExit{
            unreadable ? status : kUsageStatus, "vsplit-pda: " + describe(error) + "\n"};
    }
    return options;
}

}  // namespace vsplit::client
