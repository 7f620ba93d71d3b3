#pragma once

#include "core/result.h"
#include "net/source_encoder.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace vsplit::net {

/// How a server listens and how much it takes on.
struct ServerSettings
{
    std::string address = "127.0.0.1";  ///< Numeric IPv4 or IPv6 address.
    std::uint16_t port = 0;             ///< 0 lets the system pick one.
    std::size_t threads = 2;            ///< Threads that serve connections.
    std::size_t max_sessions = 256;     ///< Further clients are answered with Overloaded.
    std::chrono::seconds idle_timeout{60};
    std::chrono::seconds grace{10};  ///< How long transfers may go on after SIGTERM or SIGINT.
};

/// The listener and its sessions. Not thread safe.
class Server
{
public:
    /// `root`: absolute, canonical folder of the models; `encoder`: how to treat source meshes.
    Server(ServerSettings settings, std::filesystem::path root, EncoderSettings encoder);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Opens the port. Returns the address and port to connect to, "[::1]:7420" for IPv6.
    /// Errors: BadRequest for a malformed address, IoError when the port cannot be had.
    [[nodiscard]] Result<std::string> listen();

    /// Serves until SIGTERM or SIGINT came and the sessions have ended, at the latest after the grace
    /// period or a second signal. Blocks. Call once, after listen() succeeded.
    void run();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vsplit::net
