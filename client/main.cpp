// vsplit-pda: a simulated PDA that fetches a stream, refines it and draws every level.
#include "core/file_io.h"
#include "options.h"
#include "player.h"
#include "report.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <exception>
#include <iostream>
#include <span>
#include <string>
#include <variant>

namespace {

using namespace vsplit;

int report_error(const Error& error)
{
    std::cerr << "vsplit-pda: " << describe(error) << '\n';
    return exit_status(error.code);
}

Result<void> write_json(const client::Options& options, const client::Report& report)
{
    if (options.json.empty())
    {
        return {};
    }
    const std::string text = client::to_json(report).dump(
                                 2, ' ', false, nlohmann::ordered_json::error_handler_t::replace
                             ) +
                             "\n";
    if (options.json == "-")
    {
        std::cout << text << std::flush;
        return std::cout ? Result<void>{} : fail(ErrorCode::IoError, "cannot write the report");
    }
    return write_file_atomically(options.json, std::as_bytes(std::span(text)));
}

int run(const client::Options& options)
{
    // Programs read standard output when they asked for JSON there; people then read the other one.
    std::ostream& out = options.json == "-" ? std::cerr : std::cout;
    client::Player player(options, out);
    const auto played = player.run();
    const auto written = write_json(options, player.report());
    if (!played)
    {
        return report_error(played.error());
    }
    return written ? 0 : report_error(written.error());
}

}  // namespace

int main(int argc, char** argv)
{
    std::signal(SIGPIPE, SIG_IGN);
    try
    {
        const auto parsed = client::parse_options(argc, argv);
        if (const auto* exit = std::get_if<client::EarlyExit>(&parsed))
        {
            (exit->status == 0 ? std::cout : std::cerr) << exit->text;
            return exit->status;
        }
        return run(std::get<client::Options>(parsed));
    }
    catch (const std::exception& error)
    {
        return report_error({ErrorCode::Internal, error.what()});
    }
}
