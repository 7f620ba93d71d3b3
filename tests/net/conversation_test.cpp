#include "net/conversation.h"

#include "net/test_streams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vsplit::net {
namespace {

using test::Bytes;
using testing::ElementsAre;
using wire::FrameType;

const std::vector<std::uint32_t> kChunks = {900, 5'000, 40'000};

Bytes open_frame(wire::Open open = {})
{
    if (open.model.empty())
    {
        open.model = "cow";
    }
    return encode(open).value();
}

/// Takes at most `most` outputs and joins them.
Bytes drain(Conversation& conversation, std::size_t most = 100'000)
{
    Bytes sent;
    for (; most > 0; --most)
    {
        const Output output = conversation.next_output();
        if (output.empty())
        {
            break;
        }
        sent.insert(sent.end(), output.head.begin(), output.head.end());
        sent.insert(sent.end(), output.body.begin(), output.body.end());
    }
    return sent;
}

class ConversationTest : public testing::Test
{
protected:
    /// Sends a request and answers it with the stream.
    void open(const wire::Open& open = {})
    {
        conversation_.receive(open_frame(open));
        const auto request = conversation_.take_request();
        ASSERT_TRUE(request);
        conversation_.answer(request->number, stream_);
    }

    void send(FrameType type) { conversation_.receive(wire::make_frame(type)); }

    [[nodiscard]] Bytes file() const { return {stream_->bytes.begin(), stream_->bytes.end()}; }

    StreamPtr stream_ = test::make_served_stream(kChunks, 1);
    Conversation conversation_;
};

TEST_F(ConversationTest, SendsTheWholeFileAndLittleElse)
{
    open();
    const auto talk = test::understand(drain(conversation_));
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::ModelInfo, FrameType::Data, FrameType::Done));
    EXPECT_EQ(talk.data, file());
    EXPECT_EQ(talk.infos[0].file_bytes, file().size());
    EXPECT_EQ(talk.infos[0].end, file().size());
    EXPECT_EQ(talk.infos[0].content_id, stream_->content_id);
    EXPECT_LE(talk.bytes - talk.data.size(), 64 + talk.data.size() / 100);
    EXPECT_FALSE(conversation_.busy());
    EXPECT_FALSE(conversation_.closing());
    EXPECT_EQ(conversation_.data_bytes(), file().size());
}

TEST_F(ConversationTest, OverheadOfTheSmallestTransferFitsItsBudget)
{
    stream_ = test::make_served_stream({1}, 1);
    open();
    const auto talk = test::understand(drain(conversation_));
    EXPECT_EQ(talk.data, file());
    EXPECT_LE(talk.bytes - talk.data.size(), 64U);
}

TEST_F(ConversationTest, StopsWhereTheConditionSays)
{
    const auto& levels = stream_->info.levels;
    const auto end_of = [this](const wire::StopRequest& stop) {
        Conversation conversation;
        conversation.receive(open_frame({.model = "m", .stop = stop}));
        conversation.answer(conversation.take_request()->number, stream_);
        const auto talk = test::understand(drain(conversation));
        EXPECT_EQ(talk.data.size(), talk.infos[0].end);
        return talk.infos[0].end;
    };
    const double diagonal = stream_->info.diagonal();
    EXPECT_EQ(end_of({.level = 1}), levels[1].cumulative_bytes);
    EXPECT_EQ(end_of({.level = 0}), levels[0].cumulative_bytes);
    EXPECT_EQ(end_of({.bytes = levels[1].cumulative_bytes + 5}), levels[1].cumulative_bytes);
    EXPECT_EQ(end_of({.bytes = 0}), levels[0].cumulative_bytes);
    EXPECT_EQ(end_of({.faces = levels[1].faces}), levels[1].cumulative_bytes);
    EXPECT_EQ(end_of({.error = levels[1].rms_error}), levels[1].cumulative_bytes);
    EXPECT_EQ(
        end_of(
            {.error = 100.01 * levels[1].rms_error / diagonal,
             .error_unit = wire::ErrorUnit::DiagonalPercent}
        ),
        levels[1].cumulative_bytes
    );
}

TEST_F(ConversationTest, ResumesAtEveryByte)
{
    stream_ = test::make_served_stream({30, 20}, 2);
    const Bytes whole = file();
    for (std::size_t start = 0; start <= whole.size(); ++start)
    {
        Conversation conversation;
        conversation.receive(
            open_frame({.model = "m", .start = start, .content_id = stream_->content_id})
        );
        conversation.answer(conversation.take_request()->number, stream_);
        const auto talk = test::understand(drain(conversation));
        EXPECT_EQ(talk.data, Bytes(whole.begin() + start, whole.end())) << start;
        EXPECT_EQ(talk.infos[0].start, start);
        EXPECT_EQ(talk.dones.size(), 1U);
    }
}

TEST_F(ConversationTest, GoesOnToAFinerLevelOnTheSameConnection)
{
    open({.model = "cow", .stop = {.level = 0}});
    const auto coarse = test::understand(drain(conversation_));
    open({.model = "cow", .start = coarse.data.size(), .content_id = coarse.infos[0].content_id});
    const auto fine = test::understand(drain(conversation_));
    EXPECT_EQ(test::joined(coarse.data, fine.data), file());
}

TEST_F(ConversationTest, SaysThatTheContentHasChanged)
{
    open({.model = "cow", .start = 10, .content_id = stream_->content_id + 1});
    const auto talk = test::understand(drain(conversation_));
    ASSERT_THAT(talk.frames, ElementsAre(FrameType::Failure));
    EXPECT_EQ(talk.failures[0].code, static_cast<unsigned>(ErrorCode::ContentChanged));
    EXPECT_FALSE(talk.failures[0].closing);
    open();
    EXPECT_EQ(test::understand(drain(conversation_)).data, file());
}

TEST_F(ConversationTest, RefusesAStartBeyondTheFile)
{
    open({.model = "cow", .start = file().size() + 1, .content_id = stream_->content_id});
    const auto talk = test::understand(drain(conversation_));
    ASSERT_THAT(talk.frames, ElementsAre(FrameType::Failure));
    EXPECT_EQ(talk.failures[0].code, static_cast<unsigned>(ErrorCode::BadRequest));
    EXPECT_FALSE(conversation_.closing());
}

TEST_F(ConversationTest, PauseStopsDataAndResumeGoesOn)
{
    open();
    Bytes sent = drain(conversation_, 2);
    send(FrameType::Pause);
    EXPECT_TRUE(conversation_.next_output().empty());
    EXPECT_TRUE(conversation_.waits_for_client());
    send(FrameType::Pause);
    send(FrameType::Resume);
    EXPECT_FALSE(conversation_.waits_for_client());
    sent = test::joined(sent, drain(conversation_));
    EXPECT_EQ(test::understand(sent).data, file());
}

TEST_F(ConversationTest, CancelEndsTheTransferAfterAWholeFrame)
{
    open();
    Bytes sent = drain(conversation_, 1);
    send(FrameType::Cancel);
    sent = test::joined(sent, drain(conversation_));
    const auto talk = test::understand(sent);
    EXPECT_TRUE(talk.complete);
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::ModelInfo, FrameType::Data, FrameType::Done));
    EXPECT_EQ(talk.dones[0].reason, wire::DoneReason::Cancelled);
    EXPECT_EQ(talk.data.size(), proto::kSentDataBytes);
}

TEST_F(ConversationTest, CancelWhilePausedEndsThePause)
{
    open();
    send(FrameType::Pause);
    send(FrameType::Cancel);
    static_cast<void>(drain(conversation_));
    open();
    EXPECT_EQ(test::understand(drain(conversation_)).data, file());
}

TEST_F(ConversationTest, AnswerToACancelledRequestIsDropped)
{
    conversation_.receive(open_frame());
    const auto first = conversation_.take_request();
    send(FrameType::Cancel);
    conversation_.receive(open_frame({.model = "other"}));
    conversation_.answer(first->number, stream_);
    const auto talk = test::understand(drain(conversation_));
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::Done));
    EXPECT_EQ(conversation_.take_request()->open.model, "other");
}

TEST_F(ConversationTest, ControlWithoutTransferChangesNothing)
{
    send(FrameType::Cancel);
    send(FrameType::Pause);
    send(FrameType::Resume);
    EXPECT_TRUE(conversation_.next_output().empty());
    send(FrameType::Pause);
    open();
    EXPECT_EQ(test::understand(drain(conversation_)).data, file());
}

TEST_F(ConversationTest, PingIsAnsweredAheadOfData)
{
    open();
    Bytes sent = drain(conversation_, 1);
    const Bytes token(proto::kPingBytes, std::byte{7});
    conversation_.receive(wire::make_frame(FrameType::Ping, Bytes(proto::kPingBytes)));
    conversation_.receive(wire::make_frame(FrameType::Ping, token));
    const Output output = conversation_.next_output();
    const Bytes pong = wire::make_frame(FrameType::Pong, token);
    ASSERT_GE(output.head.size(), pong.size());
    EXPECT_TRUE(std::ranges::equal(output.head.first(pong.size()), pong));
}

TEST_F(ConversationTest, WaitingIsReportedOnlyWhilePreparing)
{
    conversation_.report_waiting();
    EXPECT_TRUE(conversation_.next_output().empty());
    conversation_.receive(open_frame());
    conversation_.report_waiting();
    conversation_.report_waiting();
    const auto talk = test::understand(drain(conversation_));
    EXPECT_THAT(talk.frames, ElementsAre(FrameType::Waiting));
}

TEST_F(ConversationTest, OpenDuringATransferClosesTheConnection)
{
    open();
    conversation_.receive(open_frame());
    const auto talk = test::understand(drain(conversation_));
    EXPECT_EQ(talk.failures.at(0).code, static_cast<unsigned>(ErrorCode::BadRequest));
    EXPECT_TRUE(talk.failures[0].closing);
    EXPECT_TRUE(conversation_.closing());
    EXPECT_FALSE(conversation_.busy());
}

TEST_F(ConversationTest, UnknownVersionIsRefusedAndMayBeTriedAgain)
{
    conversation_.receive(open_frame({.model = "cow", .min_version = 7, .max_version = 9}));
    const auto talk = test::understand(drain(conversation_));
    EXPECT_EQ(talk.failures.at(0).code, static_cast<unsigned>(ErrorCode::UnsupportedVersion));
    open();
    EXPECT_EQ(test::understand(drain(conversation_)).data, file());
}

TEST_F(ConversationTest, AClientThatAsksWithoutReadingIsCutOff)
{
    for (int i = 0; i < 10'000 && !conversation_.closing(); ++i)
    {
        conversation_.receive(open_frame());
        send(FrameType::Cancel);
    }
    EXPECT_TRUE(conversation_.closing());
    EXPECT_LE(drain(conversation_).size(), 8192U);
}

TEST_F(ConversationTest, OutputStaysValidWhenTheTransferEndsMeanwhile)
{
    open();
    const Output output = conversation_.next_output();
    const Bytes expected(output.body.begin(), output.body.end());
    std::weak_ptr<const ServedStream> watch = stream_;
    stream_.reset();
    send(FrameType::Cancel);
    EXPECT_FALSE(watch.expired());
    EXPECT_TRUE(std::ranges::equal(output.body, expected));
    static_cast<void>(drain(conversation_));
    EXPECT_TRUE(watch.expired());
}

TEST_F(ConversationTest, NoiseIsAnsweredWithACodeAndBoundedMemory)
{
    std::mt19937 random(5);
    for (int round = 0; round < 2'000; ++round)
    {
        Bytes noise(1 + random() % 200);
        std::generate(noise.begin(), noise.end(), [&] { return static_cast<std::byte>(random()); });
        // Most rounds begin like a frame, so that they get past the frame parser.
        if (round % 4 != 0 && noise.size() > 4)
        {
            noise[1] = noise[2] = std::byte{0};
            noise[3] = static_cast<std::byte>(1 + random() % 5);
        }
        Conversation conversation;
        conversation.receive(noise);
        conversation.receive(noise);
        const auto talk = test::understand(drain(conversation));
        EXPECT_TRUE(talk.complete) << round;
        EXPECT_LE(talk.failures.size(), 1U) << round;
        EXPECT_EQ(talk.failures.size() == 1, conversation.closing()) << round;
    }
}

}  // namespace
}  // namespace vsplit::net
