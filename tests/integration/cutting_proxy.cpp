#include "integration/cutting_proxy.h"

#include "wire/frame.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <utility>

namespace vsplit::test {
namespace {

constexpr auto kTick = std::chrono::milliseconds(2);
constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

/// Counts the Data payload in what a server sends and finds where to cut.
class PayloadCounter
{
public:
    /// Takes the server's next bytes; returns how many of them may pass until `allowed` more payload
    /// bytes have passed. `payload` receives how many payload bytes are among them.
    std::size_t pass(
        std::span<const std::byte> bytes, std::uint64_t allowed, std::uint64_t& payload
    )
    {
        payload = 0;
        std::span<const std::byte> left = bytes;
        while (!left.empty())
        {
            const auto frame = parser_.next(left);
            if (!frame || !*frame)
            {
                break;
            }
            if ((*frame)->type != wire::FrameType::Data)
            {
                continue;
            }
            payload += (*frame)->payload.size();
            if (payload >= allowed)
            {
                const auto surplus = static_cast<std::size_t>(payload - allowed);
                payload = allowed;
                return bytes.size() - left.size() - surplus;
            }
        }
        return bytes.size();
    }

private:
    wire::FrameParser parser_{wire::Sender::Server};
};

}  // namespace

CuttingProxy::CuttingProxy(
    std::uint16_t server_port, std::vector<std::uint64_t> cuts, std::function<void()> before_cut
)
    : server_port_(server_port),
      cuts_(std::move(cuts)),
      before_cut_(std::move(before_cut)),
      listener_(Socket::listen())
{
    thread_ = std::thread([this] { serve(); });
}

CuttingProxy::~CuttingProxy()
{
    stopping_ = true;
    thread_.join();
}

void CuttingProxy::serve()
{
    while (!stopping_)
    {
        const auto client = listener_.accept(kTick);
        if (client)
        {
            const std::size_t number = connections_++;
            relay(*client, number < cuts_.size() ? cuts_[number] : kNever);
        }
    }
}

void CuttingProxy::relay(const Socket& client, std::uint64_t cut)
{
    const Socket server = Socket::connect(server_port_);
    if (!server.open())
    {
        return;
    }
    PayloadCounter counter;
    std::array<std::byte, 16 * 1024> buffer;
    while (!stopping_)
    {
        if (client.readable(std::chrono::milliseconds(0)))
        {
            const auto count = client.receive(buffer).value_or(0);
            if (count == 0 || !server.send(std::span(buffer).first(count)))
            {
                return;
            }
        }
        if (!server.readable(kTick))
        {
            continue;
        }
        const auto count = server.receive(buffer).value_or(0);
        if (count == 0)
        {
            return;
        }
        const std::uint64_t allowed =
            cut == kNever ? kNever : cut - std::min<std::uint64_t>(cut, payload_bytes_);
        std::uint64_t payload = 0;
        const auto passed = counter.pass(std::span(buffer).first(count), allowed, payload);
        payload_bytes_ += payload;
        const bool sent = client.send(std::span(buffer).first(passed));
        if (payload >= allowed)
        {
            before_cut_();
        }
        if (!sent || payload >= allowed)
        {
            return;
        }
    }
}

}  // namespace vsplit::test
