#include "scripted_server.h"

#include <algorithm>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace vsplit::client {

Peer::~Peer()
{
    ::close(socket_);
}

std::optional<wire::Frame> Peer::receive()
{
    while (true)
    {
        auto frame = parser_.next(rest_);
        if (!frame)
        {
            return std::nullopt;
        }
        if (*frame)
        {
            return **frame;
        }
        input_.resize(4096);
        const ssize_t count = ::recv(socket_, input_.data(), input_.size(), 0);
        if (count <= 0)
        {
            return std::nullopt;
        }
        rest_ = std::span(input_).first(static_cast<std::size_t>(count));
    }
}

std::optional<wire::Open> Peer::receive_open()
{
    const auto frame = receive();
    if (!frame || frame->type != wire::FrameType::Open)
    {
        return std::nullopt;
    }
    const auto open = wire::parse_open(frame->payload);
    return open ? std::optional(*open) : std::nullopt;
}

void Peer::send(std::span<const std::byte> bytes)
{
    while (!bytes.empty())
    {
        const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count <= 0)
        {
            return;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

void Peer::send_info(const wire::Open& open, std::uint64_t file_bytes, std::uint64_t end)
{
    wire::ModelInfo info;
    info.content_id = content_id;
    info.file_bytes = file_bytes;
    info.start = open.start;
    info.end = end;
    send(wire::encode(info));
}

void Peer::send_data(std::span<const std::byte> bytes, std::size_t frame_bytes)
{
    while (!bytes.empty())
    {
        const auto part = bytes.first(std::min(frame_bytes, bytes.size()));
        send(wire::make_frame(wire::FrameType::Data, part));
        bytes = bytes.subspan(part.size());
    }
}

ScriptedServer::ScriptedServer(std::vector<Script> scripts)
{
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof(address);
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_, generic, length) != 0 || ::listen(listener_, 8) != 0 ||
        ::getsockname(listener_, generic, &length) != 0)
    {
        throw std::runtime_error("cannot listen on loopback");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, scripts = std::move(scripts)] {
        for (const Script& script : scripts)
        {
            const int connection = ::accept(listener_, nullptr, nullptr);
            if (connection < 0)
            {
                return;
            }
            Peer peer(connection);
            script(peer);
        }
        ::shutdown(listener_, SHUT_RDWR);
    });
}

ScriptedServer::~ScriptedServer()
{
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
}

}  // namespace vsplit::client
