#pragma once

#include "core/result.h"
#include "net/server.h"
#include "net/source_encoder.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vsplit::net {

/// What the command line of vsplitd says.
struct Options
{
    std::filesystem::path root;
    ServerSettings server;
    EncoderSettings encoder;
    std::string log_level;
};

/// An address with a port, as written by a user.
struct ListenAddress
{
    std::string address;
    std::uint16_t port = 0;
};

/// Reads "ADDRESS:PORT", "[IPV6]:PORT" or ":PORT" (loopback); the port may be 0.
/// Error: BadRequest. Thread safe.
[[nodiscard]] Result<ListenAddress> parse_listen_address(std::string_view text);

/// Reads the command line and checks the folders it names; creates the cache folder.
/// Returns nothing when the program has nothing more to do (--help, --version) and has said so.
/// Errors: BadRequest for usage, NotFound and IoError for folders.
[[nodiscard]] Result<std::optional<Options>> parse_options(int argc, const char* const* argv);

}  // namespace vsplit::net
