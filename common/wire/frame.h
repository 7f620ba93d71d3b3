#pragma once

#include "core/result.h"
#include "wire_format.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::wire {

using proto::FrameType;

/// Which side of a connection sent the bytes; each side has its own frame types.
enum class Sender : std::uint8_t
{
    Client,
    Server,
};

/// A frame without its header. A Data frame may come in several pieces, in order.
struct Frame
{
    FrameType type = FrameType::Data;
    std::span<const std::byte> payload;  ///< Valid until the next call of FrameParser::next().
};

/// Returns the four bytes that precede a payload.
/// `type`: what the frame carries; `payload_bytes`: length of its payload, below 2^24. Thread safe.
[[nodiscard]] std::array<std::byte, proto::kFrameHeaderBytes> frame_header(
    FrameType type, std::size_t payload_bytes
);

/// Returns a whole frame: header and a copy of the payload.
/// `payload`: at most the limit of its type. Thread safe.
[[nodiscard]] std::vector<std::byte> make_frame(
    FrameType type, std::span<const std::byte> payload = {}
);

/// Returns the longest payload that a frame type may have, or nothing for an unknown type.
/// `type`: the byte from a frame header. Thread safe.
[[nodiscard]] std::optional<std::size_t> max_payload_bytes(std::uint8_t type);

/// Cuts the bytes of a connection into frames. Data payloads are handed out as they come, as views
/// of the input; other payloads are collected first, so memory stays below 4 KiB and a header.
/// After an error every further call gives the same error. Not thread safe. Safe on untrusted input.
/// Source: proto/WIRE_PROTOCOL.md, "Frames".
class FrameParser
{
public:
    /// Prepares a parser for what `sender` sends.
    explicit FrameParser(Sender sender) : sender_(sender) {}

    /// Takes bytes from the front of `input` until something is complete.
    /// `input`: the next bytes of the connection; what was taken is cut off its front.
    /// Returns a frame (or the next piece of a Data frame), or nothing when `input` is used up.
    /// Error: BadFrame for an unknown type, one of the wrong side, or a bad length, found when the
    /// header is complete and before any payload is kept.
    [[nodiscard]] Result<std::optional<Frame>> next(std::span<const std::byte>& input);

    /// True between frames: the connection may end here without cutting one.
    [[nodiscard]] bool at_boundary() const { return header_filled_ == 0; }

private:
    [[nodiscard]] Result<void> accept_header();
    [[nodiscard]] std::optional<Frame> take_data(std::span<const std::byte>& input);
    [[nodiscard]] std::optional<Frame> take_control(std::span<const std::byte>& input);

    Sender sender_;
    std::array<std::byte, proto::kFrameHeaderBytes> header_{};
    std::size_t header_filled_ = 0;
    FrameType type_ = FrameType::Data;
    std::size_t payload_left_ = 0;
    std::size_t payload_filled_ = 0;
    std::uint64_t frame_offset_ = 0;  ///< Where the frame starts in the connection, for errors.
    std::uint64_t taken_ = 0;
    std::optional<Error> error_;
    alignas(8) std::array<std::byte, proto::kMaxControlBytes> payload_{};
};

}  // namespace vsplit::wire
