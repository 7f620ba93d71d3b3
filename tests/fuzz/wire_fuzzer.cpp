// Feeds noise to the frame parser, in pieces, and every payload it finds to the message parser of its
// type. The first input byte picks the sender (lowest bit) and the size of the pieces (the rest).

#include "core/error.h"
#include "wire/frame.h"
#include "wire/message.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace {

using namespace vsplit;

void require(bool condition)
{
    if (!condition)
    {
        std::abort();
    }
}

/// What a parser accepts must survive being sent again.
void parse(const wire::Frame& frame)
{
    switch (frame.type)
    {
        case wire::FrameType::Open:
            if (const auto open = wire::parse_open(frame.payload))
            {
                const auto again = wire::encode(*open);
                require(again.has_value());
                const auto payload = std::span(*again).subspan(proto::kFrameHeaderBytes);
                require(wire::parse_open(payload) == *open);
            }
            break;
        case wire::FrameType::ModelInfo:
            if (const auto info = wire::parse_model_info(frame.payload))
            {
                require(info->end <= info->file_bytes && info->start <= info->file_bytes);
            }
            break;
        case wire::FrameType::Done:
            static_cast<void>(wire::parse_done(frame.payload));
            break;
        case wire::FrameType::Failure:
            if (const auto failure = wire::parse_failure(frame.payload))
            {
                require(failure->message.size() <= proto::kMaxTextBytes);
                require(!wire::to_error(*failure).message.empty());
            }
            break;
        default:
            break;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size == 0)
    {
        return 0;
    }
    wire::FrameParser parser((data[0] & 1U) != 0 ? wire::Sender::Server : wire::Sender::Client);
    const std::size_t step = 1 + (data[0] >> 1U);
    std::span<const std::byte> input = std::as_bytes(std::span(data, size)).subspan(1);
    while (!input.empty())
    {
        auto piece = input.first(std::min(step, input.size()));
        input = input.subspan(piece.size());
        while (true)
        {
            const auto frame = parser.next(piece);
            if (!frame)
            {
                return 0;
            }
            if (!*frame)
            {
                break;
            }
            require((*frame)->payload.size() <= proto::kMaxDataBytes);
            parse(**frame);
        }
    }
    return 0;
}
