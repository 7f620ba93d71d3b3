#pragma once

#include "codec/stream_info.h"
#include "core/result.h"
#include "fetch_plan.h"
#include "wire/frame.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
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
    std::uint32_t texture_limit = 0;  ///< Largest side of a texture, pixels; 0 unknown.
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

    /// Sets what to leave out from the next Open on, one range a chunk, ascending; what was received is
    /// not affected. Open then asks for the bytes up to the next of them, and once again for the rest.
    void leave_out(std::vector<ByteRange> ranges) { unwanted_ = std::move(ranges); }

    /// True when the last Open was answered and ended only because of what is left out.
    [[nodiscard]] bool has_more() const
    {
        return done() && end_ == limit_ && received_ < file_bytes_;
    }

    /// What was left out since the last call: the bytes that the sink gets next follow them.
    [[nodiscard]] std::vector<ByteRange> take_gaps() { return std::exchange(gaps_, {}); }

    /// Returns the frame that ends the transfer early. The answer still has to be awaited.
    [[nodiscard]] std::vector<std::byte> cancel();

    /// Reads bytes from the server. `sink`: called with every piece of the stream file in them.
    /// Errors: what a Failure frame says; BadFrame, BadRequest when the server breaks the protocol;
    /// ContentChanged when it serves something else than before the connection was lost.
    [[nodiscard]] Result<void> take(std::span<const std::byte> bytes, const Sink& sink);

    /// True when the last Open was answered to its end.
    [[nodiscard]] bool done() const { return state_ == State::Done; }

    /// Bytes of the stream file received or left out so far, all connections together.
    [[nodiscard]] std::uint64_t received() const { return received_; }

private:
    enum class State : std::uint8_t
    {
        Idle,       // Nothing asked yet on this connection.
        Opened,     // Open sent, ModelInfo expected.
        Receiving,  // ModelInfo read, Data expected.
        Done,       // The last Open was answered.
    };

    void pass_gaps();
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
    std::uint64_t limit_ = 0;  // Where the last Open stopped for what is left out.
    std::uint64_t received_ = 0;
    std::vector<ByteRange> unwanted_;
    std::vector<ByteRange> gaps_;
};

}  // namespace vsplit::client
