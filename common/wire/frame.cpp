#include "wire/frame.h"

#include "core/assert.h"

#include <algorithm>
#include <string>

namespace vsplit::wire {
namespace {

constexpr std::uint8_t kServerBit = 0x80;
constexpr std::size_t kLengthBits = 24;
constexpr std::uint32_t kLengthMask = (1U << kLengthBits) - 1;

struct LengthRange
{
    std::size_t least = 0;
    std::size_t most = 0;
};

std::optional<LengthRange> length_range(std::uint8_t type)
{
    switch (static_cast<FrameType>(type))
    {
        case FrameType::Pause:
        case FrameType::Resume:
        case FrameType::Cancel:
        case FrameType::Waiting:
            return LengthRange{0, 0};
        case FrameType::Ping:
        case FrameType::Pong:
            return LengthRange{proto::kPingBytes, proto::kPingBytes};
        case FrameType::Data:
            return LengthRange{1, proto::kMaxDataBytes};
        case FrameType::Open:
        case FrameType::ModelInfo:
        case FrameType::Done:
        case FrameType::Failure:
            return LengthRange{1, proto::kMaxControlBytes};
    }
    return std::nullopt;
}

std::uint32_t load_u32(std::span<const std::byte, proto::kFrameHeaderBytes> bytes)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        value |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
    }
    return value;
}

}  // namespace

std::array<std::byte, proto::kFrameHeaderBytes> frame_header(
    FrameType type, std::size_t payload_bytes
)
{
    VSPLIT_ASSERT(payload_bytes <= kLengthMask);
    const std::uint32_t value = static_cast<std::uint32_t>(payload_bytes) |
                                (static_cast<std::uint32_t>(type) << kLengthBits);
    std::array<std::byte, proto::kFrameHeaderBytes> header{};
    for (std::size_t i = 0; i < header.size(); ++i)
    {
        header[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFU);
    }
    return header;
}

std::vector<std::byte> make_frame(FrameType type, std::span<const std::byte> payload)
{
    const auto header = frame_header(type, payload.size());
    std::vector<std::byte> frame(header.size() + payload.size());
    std::ranges::copy(header, frame.begin());
    std::ranges::copy(payload, frame.begin() + header.size());
    return frame;
}

std::optional<std::size_t> max_payload_bytes(std::uint8_t type)
{
    const auto range = length_range(type);
    return range ? std::optional(range->most) : std::nullopt;
}

Result<std::optional<Frame>> FrameParser::next(std::span<const std::byte>& input)
{
    if (error_)
    {
        return tl::unexpected<Error>(*error_);
    }
    if (header_filled_ < header_.size())
    {
        const std::size_t count = std::min(header_.size() - header_filled_, input.size());
        std::copy_n(input.begin(), count, header_.begin() + header_filled_);
        input = input.subspan(count);
        header_filled_ += count;
        taken_ += count;
        if (header_filled_ < header_.size())
        {
            return std::nullopt;
        }
        VSPLIT_TRY(accept_header());
    }
    return type_ == FrameType::Data ? take_data(input) : take_control(input);
}

Result<void> FrameParser::accept_header()
{
    frame_offset_ = taken_ - header_.size();
    const std::uint32_t value = load_u32(header_);
    const auto type = static_cast<std::uint8_t>(value >> kLengthBits);
    const std::size_t length = value & kLengthMask;
    const auto range = length_range(type);
    const Sender side = (type & kServerBit) != 0 ? Sender::Server : Sender::Client;
    std::string complaint;
    if (!range || side != sender_)
    {
        complaint = "frame type " + std::to_string(type) + " is not allowed here";
    }
    else if (length < range->least || length > range->most)
    {
        complaint = "a frame of type " + std::to_string(type) + " may not have " +
                    std::to_string(length) + " bytes";
    }
    if (!complaint.empty())
    {
        error_ = Error{ErrorCode::BadFrame, std::move(complaint), frame_offset_};
        return tl::unexpected<Error>(*error_);
    }
    type_ = static_cast<FrameType>(type);
    payload_left_ = length;
    payload_filled_ = 0;
    return {};
}

std::optional<Frame> FrameParser::take_data(std::span<const std::byte>& input)
{
    const std::size_t count = std::min(payload_left_, input.size());
    if (count == 0)
    {
        return std::nullopt;
    }
    const Frame frame{type_, input.first(count)};
    input = input.subspan(count);
    taken_ += count;
    payload_left_ -= count;
    if (payload_left_ == 0)
    {
        header_filled_ = 0;
    }
    return frame;
}

std::optional<Frame> FrameParser::take_control(std::span<const std::byte>& input)
{
    const std::size_t count = std::min(payload_left_, input.size());
    std::copy_n(input.begin(), count, payload_.begin() + payload_filled_);
    input = input.subspan(count);
    taken_ += count;
    payload_filled_ += count;
    payload_left_ -= count;
    if (payload_left_ > 0)
    {
        return std::nullopt;
    }
    header_filled_ = 0;
    return Frame{type_, std::span(payload_).first(payload_filled_)};
}

}  // namespace vsplit::wire
