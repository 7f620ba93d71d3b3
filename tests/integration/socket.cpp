#include "integration/socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace vsplit::test {
namespace {

sockaddr_in loopback(std::uint16_t port)
{
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

bool wait_for(int descriptor, short events, std::chrono::milliseconds limit)
{
    pollfd entry{descriptor, events, 0};
    return ::poll(&entry, 1, static_cast<int>(limit.count())) > 0;
}

}  // namespace

Socket& Socket::operator=(Socket&& other) noexcept
{
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

Socket::~Socket()
{
    if (open())
    {
        ::close(descriptor_);
    }
}

Socket Socket::connect(std::uint16_t port, int receive_buffer)
{
    Socket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (receive_buffer > 0)
    {
        // The server's kernel sizes its send buffer by the segment size: 64 KiB on loopback.
        const int segment = 536;
        ::setsockopt(socket.descriptor_, IPPROTO_TCP, TCP_MAXSEG, &segment, sizeof(segment));
        ::setsockopt(
            socket.descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer)
        );
    }
    const sockaddr_in address = loopback(port);
    const auto* generic = reinterpret_cast<const sockaddr*>(&address);
    return ::connect(socket.descriptor_, generic, sizeof(address)) == 0 ? std::move(socket)
                                                                        : Socket();
}

Socket Socket::listen()
{
    Socket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in address = loopback(0);
    const auto* generic = reinterpret_cast<const sockaddr*>(&address);
    const bool bound = ::bind(socket.descriptor_, generic, sizeof(address)) == 0;
    return bound && ::listen(socket.descriptor_, SOMAXCONN) == 0 ? std::move(socket) : Socket();
}

std::optional<Socket> Socket::accept(std::chrono::milliseconds limit) const
{
    if (!wait_for(descriptor_, POLLIN, limit))
    {
        return std::nullopt;
    }
    const int peer = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
    return peer >= 0 ? std::optional<Socket>(std::in_place, peer) : std::nullopt;
}

std::uint16_t Socket::port() const
{
    sockaddr_in address{};
    socklen_t length = sizeof(address);
    ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &length);
    return ntohs(address.sin_port);
}

bool Socket::send(std::span<const std::byte> bytes) const
{
    while (!bytes.empty())
    {
        if (!wait_for(descriptor_, POLLOUT, std::chrono::seconds(10)))
        {
            return false;
        }
        const ssize_t sent =
            ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent <= 0)
        {
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return true;
}

std::optional<std::size_t> Socket::receive(
    std::span<std::byte> buffer, std::chrono::milliseconds limit
) const
{
    if (!readable(limit))
    {
        return std::nullopt;
    }
    const ssize_t received = ::recv(descriptor_, buffer.data(), buffer.size(), 0);
    return received > 0 ? static_cast<std::size_t>(received) : 0;
}

bool Socket::readable(std::chrono::milliseconds limit) const
{
    return wait_for(descriptor_, POLLIN, limit);
}

void Socket::shut_down() const
{
    ::shutdown(descriptor_, SHUT_RDWR);
}

}  // namespace vsplit::test
