#pragma once

#include "wire/frame.h"
#include "wire/message.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace vsplit::client {

/// The server's end of one connection in a test. Failures to send are ignored: the client may have
/// gone.
class Peer
{
public:
    /// Takes over a connected socket.
    explicit Peer(int socket) : socket_(socket) {}

    ~Peer();
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    /// Waits for the next frame; nothing when the client closed the connection. The payload is valid
    /// until the next call.
    std::optional<wire::Frame> receive();

    /// Waits for an Open; nothing when something else came.
    std::optional<wire::Open> receive_open();

    /// Sends bytes as they are.
    void send(std::span<const std::byte> bytes);

    /// Sends a ModelInfo that answers `open` for a file of `file_bytes` up to `end`.
    void send_info(const wire::Open& open, std::uint64_t file_bytes, std::uint64_t end);

    /// Sends bytes in Data frames of at most `frame_bytes`.
    void send_data(std::span<const std::byte> bytes, std::size_t frame_bytes = 16384);

    /// The content id that send_info() names.
    std::uint64_t content_id = 0x1234;

private:
    int socket_;
    wire::FrameParser parser_{wire::Sender::Client};
    std::vector<std::byte> input_;
    std::span<const std::byte> rest_;
};

/// Listens on a free loopback port and plays one script per connection, in order.
class ScriptedServer
{
public:
    /// What to do with one connection; the connection is closed when it returns.
    using Script = std::function<void(Peer&)>;

    /// Starts listening. `scripts`: for the first, second, ... connection; later ones are refused.
    explicit ScriptedServer(std::vector<Script> scripts);

    /// Stops and waits for the running script.
    ~ScriptedServer();
    ScriptedServer(const ScriptedServer&) = delete;
    ScriptedServer& operator=(const ScriptedServer&) = delete;

    /// The port to connect to.
    [[nodiscard]] std::uint16_t port() const { return port_; }

private:
    int listener_ = -1;
    std::uint16_t port_ = 0;
    std::thread thread_;
};

}  // namespace vsplit::client
