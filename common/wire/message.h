#pragma once

#include "core/result.h"
#include "wire_format.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::wire {

/// Unit of StopRequest::error.
enum class ErrorUnit : std::uint8_t
{
    ModelUnits = 0,       ///< Units of the model's coordinates.
    DiagonalPercent = 1,  ///< Percent of the diagonal of the model's bounding box.
};

/// When the server should stop sending; the first condition met stops, unset ones do not matter.
struct StopRequest
{
    std::uint32_t level = std::numeric_limits<std::uint32_t>::max();  ///< Stop at this level.
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();  ///< Prefix at most so long.
    std::uint32_t faces = std::numeric_limits<std::uint32_t>::max();  ///< At most so many faces.
    /// Stop at the first level whose RMS error is not above this; finite, >= 0; 0 none.
    double error = 0.0;
    ErrorUnit error_unit = ErrorUnit::ModelUnits;

    friend bool operator==(const StopRequest&, const StopRequest&) = default;
};

/// Client to server: who the client is, what it wants, where to start and where to stop.
struct Open
{
    std::string
        model{};  ///< Name of the model, 1 .. 255 bytes of UTF-8 without control characters.
    std::string client{};  ///< Name and version of the client program, 0 .. 255 bytes, likewise.
    std::uint16_t min_version = proto::kWireVersion;  ///< Oldest protocol version it speaks.
    std::uint16_t max_version = proto::kWireVersion;  ///< Newest protocol version it speaks.
    std::uint64_t start = 0;                          ///< First byte of the stream file to send.
    std::uint64_t content_id =
        0;  ///< Id of the content to go on with, 0 none; needed for start > 0.
    StopRequest stop{};
    std::uint16_t screen_width = 0;      ///< Pixels, 0 unknown.
    std::uint16_t screen_height = 0;     ///< Pixels, 0 unknown.
    std::uint64_t memory_bytes = 0;      ///< Memory that the client may use, 0 unknown.
    std::uint32_t max_texture_size = 0;  ///< Largest texture edge, pixels, 0 unknown; reserved.

    friend bool operator==(const Open&, const Open&) = default;
};

/// Server to client: the answer to Open; the bytes [start, end) of the file follow in Data frames.
struct ModelInfo
{
    std::uint16_t version =
        proto::kWireVersion;       ///< The protocol version that is spoken from here.
    std::uint64_t content_id = 0;  ///< See content_id(); never 0.
    std::uint64_t file_bytes = 0;  ///< Length of the stream file.
    std::uint64_t start = 0;       ///< First byte that is sent, as asked for.
    /// Where the stop condition ends the stream, at most file_bytes; no data come when start >= end.
    std::uint64_t end = 0;

    friend bool operator==(const ModelInfo&, const ModelInfo&) = default;
};

/// Why a transfer is over.
enum class DoneReason : std::uint8_t
{
    EndReached = 0,  ///< Every byte up to the end was sent.
    Cancelled = 1,   ///< The client cancelled.
};

/// Server to client: the transfer is over; another Open may follow on the connection.
struct Done
{
    DoneReason reason = DoneReason::EndReached;

    friend bool operator==(const Done&, const Done&) = default;
};

/// Server to client: the transfer failed.
struct Failure
{
    std::uint16_t code = 0;  ///< A number of ErrorCode, or one that a newer server knows; never 0.
    std::string message{};   ///< One line for people, at most 255 bytes.
    bool closing = false;    ///< True when the server closes the connection after this frame.

    friend bool operator==(const Failure&, const Failure&) = default;
};

/// Returns the frame that carries a request, header included.
/// Errors: BadRequest for a field out of the range given at its declaration. Thread safe.
[[nodiscard]] Result<std::vector<std::byte>> encode(const Open& open);

/// Returns the frame that carries an answer, header included. Thread safe.
[[nodiscard]] std::vector<std::byte> encode(const ModelInfo& info);

/// Returns the frame that ends a transfer, header included. Thread safe.
[[nodiscard]] std::vector<std::byte> encode(const Done& done);

/// Returns the frame that reports a failure, header included. The message is cut to 255 bytes; when
/// it is not valid text then, all but printable ASCII in it is replaced by '?'. Thread safe.
[[nodiscard]] std::vector<std::byte> encode(const Failure& failure);

/// Reads the payload of an Open frame.
/// Errors: BadRequest for anything malformed or out of range. Cost: linear. Thread safe.
/// Safe on untrusted input. Source: proto/WIRE_PROTOCOL.md, "Messages".
[[nodiscard]] Result<Open> parse_open(std::span<const std::byte> payload);

/// Reads the payload of a ModelInfo frame; otherwise as parse_open().
[[nodiscard]] Result<ModelInfo> parse_model_info(std::span<const std::byte> payload);

/// Reads the payload of a Done frame; otherwise as parse_open().
[[nodiscard]] Result<Done> parse_done(std::span<const std::byte> payload);

/// Reads the payload of a Failure frame; otherwise as parse_open().
[[nodiscard]] Result<Failure> parse_failure(std::span<const std::byte> payload);

/// Turns a failure that was received into an Error: codes this build does not know become Internal.
[[nodiscard]] Error to_error(const Failure& failure);

/// Picks the newest protocol version that the client and this build speak.
/// Error: UnsupportedVersion when there is none. Thread safe.
[[nodiscard]] Result<std::uint16_t> negotiate_version(const Open& open);

/// Says whether a text may travel in a message: at most 255 bytes, valid UTF-8, no control characters.
/// Thread safe. Safe on untrusted input.
[[nodiscard]] bool is_valid_text(std::string_view text);

/// Returns the number that tells two stream files apart: FNV-1a (64 bits) of header and index, which
/// hold the checksum of every chunk; 0 is replaced by 1. It notices a changed file, not an attack.
/// `header`: the first StreamInfo::header_bytes bytes of the file. Thread safe.
/// Source: Fowler, Noll, Vo; draft-eastlake-fnv.
[[nodiscard]] std::uint64_t content_id(std::span<const std::byte> header);

}  // namespace vsplit::wire
