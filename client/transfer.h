#pragma once

#include "codec/stream_info.h"
#include "core/result.h"
#include "wire/frame.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vsplit::client {

/// When the transfer should end.
struct StopPlan
{
    codec::StopCondition condition;
    bool error_in_percent = false;  ///< condition.error is percent of the bounding box's diagonal.
};

/// What the server is told about the client, and what is asked of it.
struct TransferRequest
{
    std::string model;
    std::uint32_t screen_width = 0;   ///< Pixels.
    std::uint32_t screen_height = 0;  ///< Pixels.
    std::uint64_t memory_bytes = 0;
};

/// The client's side of the conversation (proto/WIRE_PROTOCOL.md), without sockets: it makes the
/// frames to send and reads those that come. It outlives connections: what was received stays
/// received, and the next Open goes on at exactly that byte of the same content.
/// Not thread safe. Safe on untrusted input.
class Transfer
{
public:
    /// Takes a piece of the stream file; pieces come in order, without gaps.
    using Sink = std::function<void(std::span<const std::byte>)>;

    /// Prepares to ask for `request`.
    explicit Transfer(TransferRequest request);

    /// Forgets what is left of a connection's conversation; call it for every new connection.
    void start_connection();

    /// Returns the frame that asks for the bytes from received() on, up to `stop`.
    /// Precondition: no Open is unanswered. Error: BadRequest for a name that no server accepts.
    [[nodiscard]] Result<std::vector<std::byte>> open(const StopPlan& stop);

    /// Returns the frame that ends the transfer early. The answer still has to be awaited.
    [[nodiscard]] std::vector<std::byte> cancel();

    /// Reads bytes from the server. `sink`: called with every piece of the stream file in them.
    /// Errors: what a Failure frame says; BadFrame, BadRequest when the server breaks the protocol;
    /// ContentChanged when it serves something else than before the connection was lost.
    [[nodiscard]] Result<void> take(std::span<const std::byte> bytes, const Sink& sink);

    /// True when the last Open was answered to its end.
    [[nodiscard]] bool done() const { return state_ == State::Done; }

    /// Bytes of the stream file received so far, all connections together.
    [[nodiscard]] std::uint64_t received() const { return received_; }

private:
    enum class State : std::uint8_t
    {
        Idle,       // Nothing asked yet on this connection.
        Opened,     // Open sent, ModelInfo expected.
        Receiving,  // ModelInfo read, Data expected.
        Done,       // The last Open was answered.
    };

    [[nodiscard]] Result<void> handle(const wire::Frame& frame, const Sink& sink);
    [[nodiscard]] Result<void> accept_info(std::span<const std::byte> payload);
    [[nodiscard]] Result<void> accept_data(std::span<const std::byte> payload, const Sink& sink);
    [[nodiscard]] Result<void> accept_done(std::span<const std::byte> payload);

    TransferRequest request_;
    wire::FrameParser parser_{wire::Sender::Server};
    State state_ = State::Idle;
    bool cancelled_ = false;
    std::uint64_t content_id_ = 0;
    std::uint64_t file_bytes_ = 0;
    std::uint64_t end_ = 0;
    std::uint64_t received_ = 0;
};

}  // namespace vsplit::client
