#pragma once

#include "integration/child_process.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vsplit::test {

/// A vsplitd of its own on a free port of 127.0.0.1.
class ServerProcess
{
public:
    /// Starts it and waits until it says that it is ready. `options`: further arguments; `port`: 0
    /// for a free one. Throws std::runtime_error when it does not get ready.
    ServerProcess(
        const std::filesystem::path& root,
        const std::filesystem::path& logs,
        const std::vector<std::string>& options = {},
        std::uint16_t port = 0
    );

    /// The port it listens on.
    [[nodiscard]] std::uint16_t port() const { return port_; }

    /// The process, to signal and to wait for.
    [[nodiscard]] ChildProcess& process() { return process_; }

    /// Returns what vsplit-pda takes to fetch a model from here, or from a proxy's port.
    [[nodiscard]] static std::string url(std::uint16_t port, const std::string& model);

private:
    ChildProcess process_;
    std::uint16_t port_ = 0;
};

}  // namespace vsplit::test
