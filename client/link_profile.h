#pragma once

#include "core/result.h"

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace vsplit::client {

/// The radio or wire between the device and the server.
struct LinkProfile
{
    std::string name = "none";
    double bytes_per_second = 0.0;  ///< Downstream rate; 0 means as fast as the socket.
    std::chrono::milliseconds latency{
        0};  ///< Round trip, from sending a request to the first byte.

    /// True when the rate or the latency is simulated.
    [[nodiscard]] bool shaped() const { return bytes_per_second > 0.0 || latency.count() > 0; }
};

/// Finds a profile by name (none, modem28, gprs, edge, 3g, 4g, wifi) or reads KBITS:LATENCY_MS.
/// `text`: KBITS is 0.1 .. 10 000 000 (thousand bits a second), LATENCY_MS is 0 .. 60 000.
/// Error: UnsupportedInput, which lists what is accepted. Thread safe.
[[nodiscard]] Result<LinkProfile> parse_link(std::string_view text);

/// Returns the socket receive buffer that lets the server feel the link, bytes: half a second of
/// data, 4 KiB .. 256 KiB; 0 leaves the system's choice (unlimited rate).
[[nodiscard]] std::size_t receive_buffer_bytes(const LinkProfile& link);

}  // namespace vsplit::client
