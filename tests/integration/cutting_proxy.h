#pragma once

#include "integration/socket.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace vsplit::test {

/// Stands between a client and the server and cuts connections: the first one when `cuts[0]` bytes of
/// the stream file were passed on in all, the second one at `cuts[1]`, and so on; later ones never.
class CuttingProxy
{
public:
    /// Starts to listen. `server_port`: of 127.0.0.1; `cuts`: offsets in the stream, ascending;
    /// `before_cut`: called from the proxy's thread when a connection is about to be cut.
    CuttingProxy(
        std::uint16_t server_port,
        std::vector<std::uint64_t> cuts,
        std::function<void()> before_cut = [] {}
    );
    CuttingProxy(const CuttingProxy&) = delete;
    CuttingProxy& operator=(const CuttingProxy&) = delete;
    ~CuttingProxy();

    /// The port to connect to.
    [[nodiscard]] std::uint16_t port() const { return listener_.port(); }

    /// Bytes of the stream file passed to the client over all connections.
    [[nodiscard]] std::uint64_t payload_bytes() const { return payload_bytes_; }

    /// Connections that were made.
    [[nodiscard]] std::uint32_t connections() const { return connections_; }

private:
    void serve();
    void relay(const Socket& client, std::uint64_t cut);

    std::uint16_t server_port_;
    std::vector<std::uint64_t> cuts_;
    std::function<void()> before_cut_;
    Socket listener_;
    std::atomic<std::uint64_t> payload_bytes_{0};
    std::atomic<std::uint32_t> connections_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace vsplit::test
