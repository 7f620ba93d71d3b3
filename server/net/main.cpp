#include "net/options.h"
#include "net/server.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>

namespace {

constexpr int kUsageStatus = 2;

int report(const vsplit::Error& error)
{
    std::cerr << "vsplitd: " << error.message << '\n';
    const bool usage = error.code == vsplit::ErrorCode::BadRequest;
    return usage ? kUsageStatus : vsplit::exit_status(error.code);
}

void set_up_log(const std::string& level)
{
    auto logger = spdlog::stderr_logger_mt("vsplitd");
    logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
    logger->set_level(spdlog::level::from_str(level));
    logger->flush_on(spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

int serve(const vsplit::net::Options& options)
{
    set_up_log(options.log_level);
    vsplit::net::Server server(options.server, options.root, options.encoder);
    const auto address = server.listen();
    if (!address)
    {
        return report(address.error());
    }
    // Programs wait for this line to learn the port.
    std::cout << "vsplitd listening on " << *address << std::endl;
    server.run();
    spdlog::info("stopped");
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv)
{
    // A log whose reader has gone must not end the server.
    static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
    try
    {
        const auto options = vsplit::net::parse_options(argc, argv);
        if (!options)
        {
            return report(options.error());
        }
        return *options ? serve(**options) : EXIT_SUCCESS;
    }
    catch (const std::exception& error)
    {
        std::cerr << "vsplitd: " << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
