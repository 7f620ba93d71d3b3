#pragma once

#include <cstddef>
#include <cstdint>

/// Constants of the wire protocol, version 1 (proto/WIRE_PROTOCOL.md). A test compares them with the
/// tables of that document.
namespace vsplit::proto {

inline constexpr std::uint16_t kWireVersion = 1;

/// TCP port of a server that was not told another one.
inline constexpr std::uint16_t kDefaultPort = 7420;

/// A frame starts with one little-endian u32: payload length in the low 24 bits, type above.
inline constexpr std::size_t kFrameHeaderBytes = 4;

/// Longest payload of a frame other than Data.
inline constexpr std::size_t kMaxControlBytes = 4096;

/// Longest payload of a Data frame that a client must accept.
inline constexpr std::size_t kMaxDataBytes = 65536;

/// Longest payload of a Data frame that a server sends, so that Pause and Cancel act quickly.
inline constexpr std::size_t kSentDataBytes = 16384;

/// Longest model name, client name or failure message, bytes of UTF-8.
inline constexpr std::size_t kMaxTextBytes = 255;

/// Payload of Ping and Pong.
inline constexpr std::size_t kPingBytes = 8;

/// What a frame carries. Types from 0x80 on are sent by the server, the others by the client.
enum class FrameType : std::uint8_t
{
    Open = 0x01,       ///< Asks for a model (FlatBuffers table Open).
    Pause = 0x02,      ///< Stop sending data for now; empty.
    Resume = 0x03,     ///< Go on after Pause; empty.
    Cancel = 0x04,     ///< End this transfer; empty.
    Ping = 0x05,       ///< Are you there; eight bytes that Pong returns.
    ModelInfo = 0x81,  ///< What will be sent (FlatBuffers table ModelInfo).
    Data = 0x82,       ///< The next bytes of the stream file.
    Done = 0x83,       ///< The transfer is over (FlatBuffers table Done).
    Failure = 0x84,    ///< The transfer failed (FlatBuffers table Failure).
    Pong = 0x85,       ///< Answer to Ping, the same eight bytes.
    Waiting = 0x86,    ///< The model is being prepared, keep waiting; empty.
};

}  // namespace vsplit::proto
