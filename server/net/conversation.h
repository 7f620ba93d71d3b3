#pragma once

#include "core/result.h"
#include "net/served_stream.h"
#include "wire/frame.h"
#include "wire/message.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::net {

/// A request that waits for Conversation::answer().
struct PendingRequest
{
    std::uint64_t number = 0;  ///< Tells requests of one conversation apart.
    wire::Open open;
};

/// Bytes to send next, `head` before `body`; valid until the next call of a Conversation.
struct Output
{
    std::span<const std::byte> head;  ///< Frames and the header of a Data frame.
    std::span<const std::byte> body;  ///< Payload of that Data frame, in the stream's own memory.

    /// True when there is nothing to send.
    [[nodiscard]] bool empty() const { return head.empty() && body.empty(); }
};

/// The server's side of one connection as a state machine without sockets, clocks or files: bytes from
/// the client go in, requests and bytes for the client come out. Its memory is bounded whatever the
/// client does: one control message, a few answers, and one data header. Not thread safe. Safe on
/// untrusted input. Source: proto/WIRE_PROTOCOL.md, "Conversation".
class Conversation
{
public:
    /// Takes bytes that the client sent. Whatever is wrong with them is answered and closes the
    /// conversation; bytes after that are ignored.
    void receive(std::span<const std::byte> bytes);

    /// Takes the request that came in, if there is one that has not been taken.
    [[nodiscard]] std::optional<PendingRequest> take_request();

    /// Answers a request: the transfer starts, or Failure is sent. Does nothing when the client has
    /// cancelled that request meanwhile.
    /// `number`: of the PendingRequest; `stream`: not null when it has a value.
    void answer(std::uint64_t number, const Result<StreamPtr>& stream);

    /// Tells the client that its request is still being worked on, if it is.
    void report_waiting();

    /// Ends the conversation with a Failure, unless it is ending already.
    void close_with(const Error& error);

    /// Returns the bytes to send next and counts them as sent; empty when there is nothing to send.
    [[nodiscard]] Output next_output();

    /// True when the connection should be closed once everything was sent.
    [[nodiscard]] bool closing() const { return closing_; }

    /// True when a request is being worked on or a transfer has not ended.
    [[nodiscard]] bool busy() const { return state_ != State::Idle; }

    /// True when only a frame from the client can bring the conversation on.
    [[nodiscard]] bool waits_for_client() const { return state_ == State::Idle || paused_; }

    /// Frames received so far; a sign of life.
    [[nodiscard]] std::uint64_t frames_received() const { return frames_received_; }

    /// Payload bytes of Data frames given out so far, in all transfers.
    [[nodiscard]] std::uint64_t data_bytes() const { return data_bytes_; }

private:
    enum class State : std::uint8_t
    {
        Idle,       ///< No transfer.
        Preparing,  ///< An Open waits for its answer.
        Sending,    ///< ModelInfo was queued, data follow.
    };

    void handle(const wire::Frame& frame);
    void begin(std::span<const std::byte> payload);
    [[nodiscard]] Result<void> start_transfer(const StreamPtr& stream);
    void cancel();
    void finish(wire::DoneReason reason);
    void queue(std::span<const std::byte> frame);
    void queue_failure(const Error& error, bool closing);
    [[nodiscard]] std::span<const std::byte> queue_data();

    wire::FrameParser parser_{wire::Sender::Client};
    State state_ = State::Idle;
    bool paused_ = false;
    bool closing_ = false;
    std::uint64_t request_number_ = 0;
    bool request_taken_ = true;
    wire::Open open_;
    StreamPtr stream_;
    std::uint64_t position_ = 0;
    std::uint64_t end_ = 0;
    std::optional<std::array<std::byte, proto::kPingBytes>> pong_;
    std::vector<std::byte> queued_;
    std::vector<std::byte> given_out_;
    StreamPtr given_out_stream_;  ///< Keeps Output::body alive when its transfer ends meanwhile.
    std::uint64_t frames_received_ = 0;
    std::uint64_t data_bytes_ = 0;
};

}  // namespace vsplit::net
