#pragma once

#include "link_profile.h"

#include <boost/asio/ip/tcp.hpp>

namespace vsplit::client {

/// Opens a socket for connecting to `endpoint` over a link, closing what it was before.
/// Result: what the system refuses; success otherwise.
[[nodiscard]] boost::system::error_code prepare_socket(
    boost::asio::ip::tcp::socket& socket,
    const boost::asio::ip::tcp::endpoint& endpoint,
    const LinkProfile& link
);

}  // namespace vsplit::client
