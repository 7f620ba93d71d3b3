#include "client_socket.h"

#include "link_shaper.h"

namespace vsplit::client {

boost::system::error_code prepare_socket(
    boost::asio::ip::tcp::socket& socket,
    const boost::asio::ip::tcp::endpoint& endpoint,
    const LinkProfile& link
)
{
    boost::system::error_code result;
    socket.close(result);
    socket.open(endpoint.protocol(), result);
    if (result)
    {
        return result;
    }
    // Before connecting, so that the window that the server sees is small from the start.
    const std::size_t receive_bytes = receive_buffer_bytes(link);
    if (receive_bytes > 0)
    {
        const auto size = static_cast<int>(receive_bytes);
        socket.set_option(boost::asio::socket_base::receive_buffer_size(size), result);
    }
    boost::system::error_code ignored;
    socket.set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    return result;
}

}  // namespace vsplit::client
