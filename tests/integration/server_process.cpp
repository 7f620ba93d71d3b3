#include "integration/server_process.h"

#include <chrono>
#include <regex>
#include <stdexcept>
#include <thread>

namespace vsplit::test {
namespace {

std::vector<std::string> command(
    const std::filesystem::path& root, const std::vector<std::string>& options, std::uint16_t port
)
{
    std::vector<std::string> arguments{
        program("vsplitd"),
        "--root",
        root.string(),
        "--listen",
        "127.0.0.1:" + std::to_string(port)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
}

}  // namespace

ServerProcess::ServerProcess(
    const std::filesystem::path& root,
    const std::filesystem::path& logs,
    const std::vector<std::string>& options,
    std::uint16_t port
)
    : process_(command(root, options, port), logs)
{
    const std::regex address(R"(127\.0\.0\.1:(\d+)[^\n]*\n)");
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < deadline && process_.running())
    {
        const std::string line = process_.output();
        std::smatch match;
        if (std::regex_search(line, match, address))
        {
            port_ = static_cast<std::uint16_t>(std::stoul(match[1].str()));
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    throw std::runtime_error("vsplitd did not get ready: " + process_.errors());
}

std::string ServerProcess::url(std::uint16_t port, const std::string& model)
{
    return "127.0.0.1:" + std::to_string(port) + "/" + model;
}

}  // namespace vsplit::test
