#pragma once

#include "address.h"
#include "byte_queue.h"
#include "core/result.h"
#include "link_profile.h"
#include "transfer.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

namespace vsplit::client {

/// What to fetch, from where and over which link.
struct ConnectionOptions
{
    Address address;
    TransferRequest request;  ///< request.model is taken from the address when empty.
    StopPlan stop;
    LinkProfile link;
    std::chrono::milliseconds timeout{30000};  ///< Silence of the server that ends a connection.
    unsigned retries = 5;             ///< Attempts in a row without a new byte before giving up.
    std::size_t queue_bytes = 65536;  ///< Received bytes that may wait to be decoded.
};

/// What went over the wire so far.
struct TransferCounters
{
    std::uint64_t payload_bytes = 0;  ///< Bytes of the stream file.
    std::uint64_t wire_bytes = 0;     ///< All bytes received from the socket, framing included.
    std::uint32_t reconnects = 0;     ///< Connections made after the first.
};

/// Fetches a stream on its own thread and hands its bytes over in order through a bounded queue.
/// A lost connection is made again, with growing pauses, and goes on at the byte after the last one
/// received. While the queue is full nothing is read from the socket, so a slow reader slows the
/// server. Public functions may be called from one thread other than the connection's own.
class Connection
{
public:
    /// Starts connecting. Nothing fails here: see error().
    explicit Connection(ConnectionOptions options);

    /// Ends the connection without waiting for the server, and joins the thread.
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// The bytes of the stream, from byte 0 on. It is drained when the transfer is over, for good
    /// (error() is empty) or not.
    [[nodiscard]] ByteQueue& bytes();

    /// Ends the running transfer and asks for the rest with an earlier stop, leaving out what is not
    /// wanted, one range a chunk, ascending. Bytes beyond that stop or of such chunks that were on their
    /// way may still come: leaves_out() tells.
    void restrict_to(const StopPlan& stop, std::vector<ByteRange> unwanted = {});

    /// True when the chunk that begins at byte `offset` of the file does not come: what follows in the
    /// queue is the next one. Reliable once a byte behind it is in the queue or the queue is drained.
    [[nodiscard]] bool leaves_out(std::uint64_t offset) const;

    /// Why the transfer failed; nothing while it runs or when it went well.
    [[nodiscard]] std::optional<Error> error() const;

    /// What was received so far.
    [[nodiscard]] TransferCounters counters() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vsplit::client
