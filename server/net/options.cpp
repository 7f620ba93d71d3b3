#include "net/options.h"

#include "wire_format.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <iostream>
#include <system_error>

namespace vsplit::net {
namespace {

#ifdef VSPLIT_SHADOW_MEMORY
// The shadow memory of the sanitizers takes terabytes of address space.
constexpr std::uint64_t kDefaultEncodeMegabytes = 0;
#else
constexpr std::uint64_t kDefaultEncodeMegabytes = 4096;
#endif

/// The command line as CLI11 fills it in.
struct RawOptions
{
    std::string root;
    std::string listen = "127.0.0.1:" + std::to_string(proto::kDefaultPort);
    std::string cache;
    std::string encoder;
    std::uint64_t encode_megabytes = kDefaultEncodeMegabytes;
    std::int64_t encode_seconds = 600;
    std::size_t threads = 2;
    std::size_t max_sessions = 256;
    std::int64_t idle_seconds = 60;
    std::int64_t grace_seconds = 10;
    std::string log_level = "info";
};

void declare(CLI::App& app, RawOptions& raw)
{
    app.set_version_flag("--version", "vsplitd " VSPLIT_VERSION);
    app.add_option("--root", raw.root, "Folder whose models are served")->required();
    app.add_option("--listen", raw.listen, "ADDRESS:PORT to listen on, port 0 picks one")
        ->capture_default_str();
    app.add_option(
        "--cache", raw.cache, "Folder for encoded source meshes; without it they are refused"
    );
    app.add_option("--encoder", raw.encoder, "The vsplit tool; default: beside this program");
    app.add_option(
           "--encode-memory", raw.encode_megabytes, "Address space of an encoder, MB, 0 no bound"
    )
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 30))
        ->capture_default_str();
    app.add_option("--encode-time", raw.encode_seconds, "Longest time for one mesh, seconds")
        ->check(CLI::Range(1, 86'400))
        ->capture_default_str();
    app.add_option("--threads", raw.threads, "Threads that serve connections")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    app.add_option("--max-sessions", raw.max_sessions, "Clients served at the same time")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    app.add_option("--idle-timeout", raw.idle_seconds, "Longest silence of a client, seconds")
        ->check(CLI::Range(1, 86'400))
        ->capture_default_str();
    app.add_option(
           "--grace", raw.grace_seconds, "Time for running transfers after SIGTERM, seconds"
    )
        ->check(CLI::Range(0, 86'400))
        ->capture_default_str();
    app.add_option("--log-level", raw.log_level, "What to log on standard error")
        ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
        ->capture_default_str();
}

Result<std::filesystem::path> existing_folder(const std::string& text, const std::string& option)
{
    std::error_code error;
    const auto path = std::filesystem::canonical(text, error);
    if (error)
    {
        return fail(ErrorCode::NotFound, option + " " + text + ": " + error.message());
    }
    if (!std::filesystem::is_directory(path, error))
    {
        return fail(ErrorCode::IoError, option + " " + text + " is not a folder");
    }
    return path;
}

Result<std::filesystem::path> cache_folder(const std::string& text)
{
    std::error_code error;
    std::filesystem::create_directories(text, error);
    if (error)
    {
        return fail(ErrorCode::IoError, "cannot make --cache " + text + ": " + error.message());
    }
    return existing_folder(text, "--cache");
}

std::filesystem::path encoder_program(const std::string& text)
{
    std::error_code error;
    if (text.empty())
    {
        return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "vsplit";
    }
    const auto path = std::filesystem::absolute(text, error);
    return error ? std::filesystem::path(text) : path;
}

Result<Options> check(const RawOptions& raw)
{
    Options options;
    const auto root = existing_folder(raw.root, "--root");
    VSPLIT_TRY(root);
    options.root = *root;
    const auto listen = parse_listen_address(raw.listen);
    VSPLIT_TRY(listen);
    options.server = ServerSettings{
        .address = listen->address,
        .port = listen->port,
        .threads = raw.threads,
        .max_sessions = raw.max_sessions,
        .idle_timeout = std::chrono::seconds(raw.idle_seconds),
        .grace = std::chrono::seconds(raw.grace_seconds),
    };
    if (!raw.cache.empty())
    {
        const auto cache = cache_folder(raw.cache);
        VSPLIT_TRY(cache);
        options.encoder.cache = *cache;
    }
    options.encoder.program = encoder_program(raw.encoder);
    options.encoder.memory_bytes = raw.encode_megabytes << 20U;
    options.encoder.time_limit = std::chrono::seconds(raw.encode_seconds);
    options.log_level = raw.log_level;
    return options;
}

}  // namespace

Result<ListenAddress> parse_listen_address(std::string_view text)
{
    const auto bad = [text] {
        return fail(
            ErrorCode::BadRequest,
            "--listen '" + std::string(text) + "' is not ADDRESS:PORT, e.g. 127.0.0.1:0"
        );
    };
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos)
    {
        return bad();
    }
    const std::string_view digits = text.substr(colon + 1);
    ListenAddress listen;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), listen.port);
    if (error != std::errc() || end != digits.data() + digits.size())
    {
        return bad();
    }
    std::string_view address = text.substr(0, colon);
    const bool bracketed = address.starts_with('[') && address.ends_with(']');
    if (bracketed)
    {
        address = address.substr(1, address.size() - 2);
    }
    if (bracketed != (address.find(':') != std::string_view::npos))
    {
        return bad();
    }
    listen.address = address.empty() ? "127.0.0.1" : std::string(address);
    return listen;
}

Result<std::optional<Options>> parse_options(int argc, const char* const* argv)
{
    CLI::App app("Serves progressive meshes (vsplit streams) over TCP.", "vsplitd");
    RawOptions raw;
    declare(app, raw);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
        {
            app.exit(error, std::cout, std::cerr);
            return std::nullopt;
        }
        return fail(ErrorCode::BadRequest, std::string(error.what()) + " (try --help)");
    }
    auto options = check(raw);
    VSPLIT_TRY(options);
    return std::move(*options);
}

}  // namespace vsplit::net
