#pragma once

#include "integration/socket.h"
#include "wire/frame.h"
#include "wire/message.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace vsplit::test {

/// A frame with its own copy of the payload; pieces of a Data frame come one by one.
struct ReceivedFrame
{
    wire::FrameType type = wire::FrameType::Data;
    std::vector<std::byte> payload;
};

/// What one Open brought.
struct Transfer
{
    std::optional<wire::ModelInfo> info;
    std::vector<std::byte> payload;  ///< Data payloads in order.
    std::uint64_t wire_bytes = 0;    ///< Bytes received from Open to Done or Failure.
    std::uint32_t waiting = 0;       ///< Waiting frames.
    std::optional<wire::DoneReason> done;
    std::optional<wire::Failure> failure;
};

/// Speaks the wire protocol over a plain socket, so that tests see every byte and can misbehave.
class RawClient
{
public:
    /// Connects to a port of 127.0.0.1. `receive_buffer` as for Socket::connect().
    explicit RawClient(std::uint16_t port, int receive_buffer = 0);

    /// Sends bytes as they are. False when the peer has gone.
    [[nodiscard]] bool send(std::span<const std::byte> bytes) const { return socket_.send(bytes); }

    /// Sends an Open frame.
    [[nodiscard]] bool open(const wire::Open& request) const;

    /// Receives the next frame, or nothing when the connection ended, broke the protocol or stayed
    /// silent for `limit`.
    [[nodiscard]] std::optional<ReceivedFrame> next(
        std::chrono::milliseconds limit = std::chrono::seconds(10)
    );

    /// Receives until Done, Failure or the end of the connection.
    [[nodiscard]] Transfer finish();

    /// Sends an Open frame and receives everything that it brings.
    [[nodiscard]] Transfer transfer(const wire::Open& request);

    /// The socket, for tests that watch or end the connection.
    [[nodiscard]] const Socket& socket() const { return socket_; }

private:
    Socket socket_;
    wire::FrameParser parser_{wire::Sender::Server};
    std::vector<std::byte> buffer_;
    std::span<const std::byte> unread_;
    std::uint64_t received_bytes_ = 0;
};

}  // namespace vsplit::test
