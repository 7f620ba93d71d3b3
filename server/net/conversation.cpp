#include "net/conversation.h"

#include <algorithm>
#include <utility>

namespace vsplit::net {
namespace {

/// A client that goes on asking without reading the answers is cut off at this backlog.
constexpr std::size_t kMaxQueuedBytes = 4096;

/// Translates what the client asked for into the terms of the index.
codec::StopCondition stop_condition(const wire::StopRequest& stop, const codec::StreamInfo& info)
{
    constexpr double kPercent = 0.01;
    const bool relative = stop.error_unit == wire::ErrorUnit::DiagonalPercent;
    const double error = relative ? stop.error * kPercent * info.diagonal() : stop.error;
    return codec::StopCondition{
        .level = stop.level,
        .bytes = stop.bytes,
        .faces = stop.faces,
        .error = error > 0.0 ? error : codec::StopCondition{}.error,
    };
}

}  // namespace

void Conversation::receive(std::span<const std::byte> bytes)
{
    while (!closing_)
    {
        const auto frame = parser_.next(bytes);
        if (!frame)
        {
            close_with(frame.error());
            return;
        }
        if (!*frame)
        {
            return;
        }
        ++frames_received_;
        handle(**frame);
    }
}

void Conversation::handle(const wire::Frame& frame)
{
    switch (frame.type)
    {
        case wire::FrameType::Open:
            begin(frame.payload);
            break;
        case wire::FrameType::Pause:
            paused_ = busy();
            break;
        case wire::FrameType::Resume:
            paused_ = false;
            break;
        case wire::FrameType::Cancel:
            cancel();
            break;
        case wire::FrameType::Ping:
            pong_.emplace();
            std::copy(frame.payload.begin(), frame.payload.end(), pong_->begin());
            break;
        default:
            close_with(Error{ErrorCode::BadFrame, "a client does not send such frames", 0});
            break;
    }
}

void Conversation::begin(std::span<const std::byte> payload)
{
    if (busy())
    {
        close_with(Error{ErrorCode::BadRequest, "a transfer is already running", 0});
        return;
    }
    if (queued_.size() > kMaxQueuedBytes)
    {
        close_with(Error{ErrorCode::BadRequest, "too many requests before reading answers", 0});
        return;
    }
    auto open = wire::parse_open(payload);
    if (!open)
    {
        close_with(open.error());
        return;
    }
    const auto version = wire::negotiate_version(*open);
    if (!version)
    {
        queue_failure(version.error(), false);
        return;
    }
    open_ = std::move(*open);
    state_ = State::Preparing;
    ++request_number_;
    request_taken_ = false;
}

std::optional<PendingRequest> Conversation::take_request()
{
    if (std::exchange(request_taken_, true))
    {
        return std::nullopt;
    }
    return PendingRequest{request_number_, open_};
}

void Conversation::answer(std::uint64_t number, const Result<StreamPtr>& stream)
{
    if (state_ != State::Preparing || number != request_number_)
    {
        return;
    }
    const Result<void> started =
        stream ? start_transfer(*stream) : tl::unexpected<Error>(stream.error());
    if (!started)
    {
        state_ = State::Idle;
        paused_ = false;
        queue_failure(started.error(), started.error().code == ErrorCode::Internal);
    }
}

Result<void> Conversation::start_transfer(const StreamPtr& stream)
{
    if (open_.content_id != 0 && open_.content_id != stream->content_id)
    {
        return fail(ErrorCode::ContentChanged, "the model has changed; begin again at byte 0");
    }
    if (open_.start > stream->bytes.size())
    {
        return fail(ErrorCode::BadRequest, "the start offset lies beyond the end of the file");
    }
    stream_ = stream;
    position_ = open_.start;
    end_ = codec::stop_offset(stream->info, stop_condition(open_.stop, stream->info));
    end_ = std::min<std::uint64_t>(end_, stream->bytes.size());
    state_ = State::Sending;
    queue(encode(wire::ModelInfo{
        .content_id = stream->content_id,
        .file_bytes = stream->bytes.size(),
        .start = position_,
        .end = end_,
    }));
    if (position_ >= end_)
    {
        finish(wire::DoneReason::EndReached);
    }
    return {};
}

void Conversation::report_waiting()
{
    if (state_ == State::Preparing && queued_.empty())
    {
        queue(wire::make_frame(wire::FrameType::Waiting));
    }
}

void Conversation::cancel()
{
    if (busy())
    {
        finish(wire::DoneReason::Cancelled);
    }
}

void Conversation::finish(wire::DoneReason reason)
{
    queue(encode(wire::Done{reason}));
    state_ = State::Idle;
    paused_ = false;
    request_taken_ = true;
    stream_.reset();
}

void Conversation::close_with(const Error& error)
{
    if (closing_)
    {
        return;
    }
    state_ = State::Idle;
    paused_ = false;
    request_taken_ = true;
    stream_.reset();
    queue_failure(error, true);
}

void Conversation::queue(std::span<const std::byte> frame)
{
    queued_.insert(queued_.end(), frame.begin(), frame.end());
}

void Conversation::queue_failure(const Error& error, bool closing)
{
    queue(encode(wire::Failure{static_cast<std::uint16_t>(error.code), error.message, closing}));
    closing_ = closing;
}

Output Conversation::next_output()
{
    given_out_.clear();
    std::swap(given_out_, queued_);
    given_out_stream_.reset();
    if (pong_)
    {
        const auto pong = wire::make_frame(wire::FrameType::Pong, *pong_);
        given_out_.insert(given_out_.end(), pong.begin(), pong.end());
        pong_.reset();
    }
    std::span<const std::byte> body;
    if (state_ == State::Sending && !paused_)
    {
        body = queue_data();
    }
    return Output{given_out_, body};
}

std::span<const std::byte> Conversation::queue_data()
{
    const auto count = std::min<std::uint64_t>(end_ - position_, proto::kSentDataBytes);
    const auto body = stream_->bytes.subspan(position_, count);
    const auto header = wire::frame_header(wire::FrameType::Data, count);
    given_out_.insert(given_out_.end(), header.begin(), header.end());
    given_out_stream_ = stream_;
    position_ += count;
    data_bytes_ += count;
    if (position_ == end_)
    {
        finish(wire::DoneReason::EndReached);
    }
    return body;
}

}  // namespace vsplit::net
