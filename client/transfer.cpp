#include "transfer.h"

#include "core/assert.h"
#include "wire/frame.h"
#include "wire/message.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

namespace vsplit::client {
namespace {

constexpr std::string_view kClientName = "vsplit-pda";

std::uint16_t saturate(std::uint32_t pixels)
{
    return static_cast<std::uint16_t>(
        std::min<std::uint32_t>(pixels, std::numeric_limits<std::uint16_t>::max())
    );
}

tl::unexpected<Error> broken(std::string_view what, std::uint64_t offset)
{
    return fail(
        ErrorCode::BadRequest, "the server broke the protocol: " + std::string(what), offset
    );
}

Result<void> accept_failure(std::span<const std::byte> payload)
{
    const auto failure = wire::parse_failure(payload);
    VSPLIT_TRY(failure);
    return tl::unexpected<Error>(wire::to_error(*failure));
}

}  // namespace

Transfer::Transfer(TransferRequest request) : request_(std::move(request)) {}

void Transfer::start_connection()
{
    parser_ = wire::FrameParser(wire::Sender::Server);
    state_ = State::Idle;
}

Result<std::vector<std::byte>> Transfer::open(const StopPlan& stop)
{
    VSPLIT_ASSERT(state_ == State::Idle || state_ == State::Done);
    pass_gaps();
    limit_ =
        unwanted_.empty() ? std::numeric_limits<std::uint64_t>::max() : unwanted_.front().begin;
    wire::Open open;
    open.model = request_.model;
    open.client = kClientName;
    open.start = received_;
    open.content_id = content_id_;
    open.stop.level = stop.condition.level;
    open.stop.bytes = std::min(stop.condition.bytes, limit_);
    open.stop.faces = stop.condition.faces;
    open.stop.error = std::max(0.0, stop.condition.error);  // 0 is "none" on the wire.
    open.stop.error_unit =
        stop.error_in_percent ? wire::ErrorUnit::DiagonalPercent : wire::ErrorUnit::ModelUnits;
    open.screen_width = saturate(request_.screen_width);
    open.screen_height = saturate(request_.screen_height);
    open.memory_bytes = request_.memory_bytes;
    open.max_texture_size = request_.texture_limit;
    state_ = State::Opened;
    cancelled_ = false;
    return wire::encode(open);
}

void Transfer::pass_gaps()
{
    std::size_t passed = 0;
    for (; passed < unwanted_.size() && unwanted_[passed].begin <= received_; ++passed)
    {
        // What lies before was received before it was known to be unwanted.
        if (unwanted_[passed].begin == received_)
        {
            gaps_.push_back(unwanted_[passed]);
            received_ = unwanted_[passed].end;
        }
    }
    unwanted_.erase(unwanted_.begin(), unwanted_.begin() + static_cast<std::ptrdiff_t>(passed));
}

std::vector<std::byte> Transfer::cancel()
{
    cancelled_ = true;
    return wire::make_frame(wire::FrameType::Cancel);
}

Result<void> Transfer::take(std::span<const std::byte> bytes, const Sink& sink)
{
    while (true)
    {
        const auto frame = parser_.next(bytes);
        VSPLIT_TRY(frame);
        if (!*frame)
        {
            return {};
        }
        VSPLIT_TRY(handle(**frame, sink));
    }
}

Result<void> Transfer::handle(const wire::Frame& frame, const Sink& sink)
{
    switch (frame.type)
    {
        case wire::FrameType::ModelInfo:
            return accept_info(frame.payload);
        case wire::FrameType::Data:
            return accept_data(frame.payload, sink);
        case wire::FrameType::Done:
            return accept_done(frame.payload);
        case wire::FrameType::Failure:
            return accept_failure(frame.payload);
        case wire::FrameType::Waiting:
            return state_ == State::Opened ? Result<void>{}
                                           : broken("it waits for no request", received_);
        default:
            return broken("a frame that nobody asked for", received_);
    }
}

Result<void> Transfer::accept_info(std::span<const std::byte> payload)
{
    if (state_ != State::Opened)
    {
        return broken("an answer that nobody asked for", received_);
    }
    const auto info = wire::parse_model_info(payload);
    VSPLIT_TRY(info);
    if (info->start != received_)
    {
        return broken("it starts at a byte that was not asked for", received_);
    }
    if (content_id_ != 0 && (info->content_id != content_id_ || info->file_bytes != file_bytes_))
    {
        return fail(
            ErrorCode::ContentChanged,
            "the model " + request_.model + " changed on the server during the transfer"
        );
    }
    content_id_ = info->content_id;
    file_bytes_ = info->file_bytes;
    end_ = info->end;
    state_ = State::Receiving;
    return {};
}

Result<void> Transfer::accept_data(std::span<const std::byte> payload, const Sink& sink)
{
    if (state_ != State::Receiving)
    {
        return broken("data that nobody asked for", received_);
    }
    if (received_ > end_ || payload.size() > end_ - received_)
    {
        return broken("more data than it announced", received_);
    }
    received_ += payload.size();
    sink(payload);
    return {};
}

Result<void> Transfer::accept_done(std::span<const std::byte> payload)
{
    const auto message = wire::parse_done(payload);
    VSPLIT_TRY(message);
    if (message->reason == wire::DoneReason::Cancelled)
    {
        if (!cancelled_ || (state_ != State::Opened && state_ != State::Receiving))
        {
            return broken("it ended a transfer that was not cancelled", received_);
        }
    }
    else if (state_ != State::Receiving || received_ < end_)
    {
        return broken("it ended the transfer early", received_);
    }
    state_ = State::Done;
    pass_gaps();
    return {};
}

}  // namespace vsplit::client
