#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace vsplit::client {

/// Where a model is served.
struct Address
{
    std::string host;  ///< Name or numeric address, without brackets.
    std::uint16_t port = 0;
    std::string model;  ///< Name at the server; may contain folders.
};

/// Reads HOST:PORT/NAME, HOST/NAME (default port) or [IPV6]:PORT/NAME.
/// `text`: from the command line. Error: BadRequest, which says what is wrong. Thread safe.
[[nodiscard]] Result<Address> parse_address(std::string_view text);

}  // namespace vsplit::client
