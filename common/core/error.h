#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vsplit {

/// Reasons why data, files or peers are refused. The numbers are pinned: they travel on the wire
/// (proto/WIRE_PROTOCOL.md) and appear in logs; never renumber, only append.
enum class ErrorCode : std::uint16_t
{
    Ok = 0,                    ///< No error; never carried by an Error.
    Truncated = 1,             ///< The data end before the structure they announce.
    BadMagic = 2,              ///< Not a vsplit stream.
    UnsupportedVersion = 3,    ///< A newer major version than this reader understands.
    UnknownRequiredChunk = 4,  ///< A chunk that may not be skipped has an unknown kind or codec.
    BadHeader = 5,             ///< A header or index field is out of its range.
    BadChecksum = 6,           ///< Header or chunk bytes differ from their checksum.
    BadChunk = 7,              ///< A chunk contradicts the index or itself.
    LimitExceeded = 8,         ///< Decoding would exceed the caller's DecodeLimits.
    TrailingBytes = 9,         ///< Bytes follow the end of the stream.
    NotAMesh = 20,             ///< The input file holds no readable mesh.
    UnsupportedInput = 21,     ///< The input format or a feature of it is not supported.
    EmptyMesh = 22,            ///< The input holds no triangle (after repair).
    BadCoordinate = 23,        ///< A coordinate is NaN or infinite.
    BadIndex = 24,             ///< A face refers to a vertex that does not exist.
    InputTooLarge = 25,        ///< The input exceeds the size that this build accepts.
    NotFound = 40,             ///< No such file or model.
    IoError = 41,              ///< The operating system refused to read or write.
    AlreadyExists = 42,        ///< The output exists and may not be replaced.
    BadRequest = 60,           ///< The peer sent a message that the protocol does not allow here.
    BadFrame = 61,             ///< A frame is malformed or too long.
    Timeout = 62,              ///< The peer did not answer in time.
    Overloaded = 63,           ///< The server has no room for another session.
    Cancelled = 64,            ///< The operation was cancelled.
    ConnectionLost = 65,       ///< The connection ended before the transfer did.
    EncodeFailed = 66,         ///< The server could not encode the source mesh.
    ContentChanged = 67,       ///< The model is not the one whose transfer was to be resumed.
    Mismatch = 80,             ///< Verification: the stream does not reproduce its source.
    Internal = 99,             ///< A defect of vsplit itself; please report it.
};

/// Why an operation on data failed.
struct Error
{
    ErrorCode code = ErrorCode::Internal;
    std::string message;       ///< One line, says which input and what to do; no final full stop.
    std::uint64_t offset = 0;  ///< Byte offset in the data at which the error was found, 0 if none.
};

/// Returns the fixed name of a code, e.g. "bad-checksum".
/// `code`: any value; unknown ones give "unknown". Never fails. Thread safe.
[[nodiscard]] std::string_view error_name(ErrorCode code);

/// Returns the process exit status for a code: 2 usage, 3 bad input mesh, 4 bad stream, 5 file
/// system, 6 network, 7 verification mismatch, 1 anything else.
/// `code`: any value. Never fails. Thread safe.
[[nodiscard]] int exit_status(ErrorCode code);

/// Formats an error as one line for people: "name: message (at byte N)".
/// `error`: any error. Thread safe.
[[nodiscard]] std::string describe(const Error& error);

}  // namespace vsplit
