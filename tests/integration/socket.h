#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace vsplit::test {

/// A TCP socket on the loopback interface, closed with the object. Every wait has a limit, so that
/// a broken server fails a test instead of hanging it.
class Socket
{
public:
    Socket() = default;

    explicit Socket(int descriptor) : descriptor_(descriptor) {}

    Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

    Socket& operator=(Socket&& other) noexcept;
    ~Socket();

    /// Connects to a port of 127.0.0.1; an unopened socket when nobody listens. `receive_buffer`:
    /// size of the kernel's receive buffer, bytes; with it the kernels hold
    /// little of what is not read; 0 for the default.
    [[nodiscard]] static Socket connect(std::uint16_t port, int receive_buffer = 0);

    /// Listens on a free port of 127.0.0.1.
    [[nodiscard]] static Socket listen();

    /// Waits for a connection on a listening socket.
    [[nodiscard]] std::optional<Socket> accept(std::chrono::milliseconds limit) const;

    /// The local port.
    [[nodiscard]] std::uint16_t port() const;

    /// Sends all bytes. False when the peer has gone or takes nothing for ten seconds.
    [[nodiscard]] bool send(std::span<const std::byte> bytes) const;

    /// Receives at least one byte into `buffer`. Returns how many, 0 when the peer has closed, nothing
    /// when no byte came within `limit`.
    [[nodiscard]] std::optional<std::size_t> receive(
        std::span<std::byte> buffer, std::chrono::milliseconds limit = std::chrono::seconds(10)
    ) const;

    /// True when bytes or the end of the connection can be received now or within `limit`.
    [[nodiscard]] bool readable(std::chrono::milliseconds limit) const;

    /// True when there is a connection or a listener.
    [[nodiscard]] bool open() const { return descriptor_ >= 0; }

    /// Ends both directions at once; the peer's next read sees the end.
    void shut_down() const;

private:
    int descriptor_ = -1;
};

}  // namespace vsplit::test
