#include "integration/raw_client.h"

#include <utility>

namespace vsplit::test {

RawClient::RawClient(std::uint16_t port, int receive_buffer)
    : socket_(Socket::connect(port, receive_buffer)), buffer_(64 * 1024)
{
}

bool RawClient::open(const wire::Open& request) const
{
    const auto frame = wire::encode(request);
    return frame && socket_.send(*frame);
}

std::optional<ReceivedFrame> RawClient::next(std::chrono::milliseconds limit)
{
    while (true)
    {
        const auto frame = parser_.next(unread_);
        if (!frame)
        {
            return std::nullopt;
        }
        if (*frame)
        {
            const auto payload = (*frame)->payload;
            return ReceivedFrame{(*frame)->type, {payload.begin(), payload.end()}};
        }
        const auto count = socket_.receive(buffer_, limit);
        if (count.value_or(0) == 0)
        {
            return std::nullopt;
        }
        received_bytes_ += *count;
        unread_ = std::span<const std::byte>(buffer_).first(*count);
    }
}

Transfer RawClient::finish()
{
    Transfer result;
    received_bytes_ = unread_.size();
    while (!result.done && !result.failure)
    {
        const auto frame = next();
        if (!frame)
        {
            break;
        }
        switch (frame->type)
        {
            case wire::FrameType::Data:
                result.payload.insert(
                    result.payload.end(), frame->payload.begin(), frame->payload.end()
                );
                break;
            case wire::FrameType::ModelInfo:
                result.info = wire::parse_model_info(frame->payload).value();
                break;
            case wire::FrameType::Done:
                result.done = wire::parse_done(frame->payload).value().reason;
                break;
            case wire::FrameType::Failure:
                result.failure = wire::parse_failure(frame->payload).value();
                break;
            case wire::FrameType::Waiting:
                ++result.waiting;
                break;
            default:
                break;
        }
    }
    result.wire_bytes = received_bytes_ - unread_.size();
    return result;
}

Transfer RawClient::transfer(const wire::Open& request)
{
    return open(request) ? finish() : Transfer{};
}

}  // namespace vsplit::test
