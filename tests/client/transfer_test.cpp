#include "transfer.h"

#include "wire/frame.h"
#include "wire/message.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vsplit::client {
namespace {

using Bytes = std::vector<std::byte>;

Bytes operator+(Bytes a, const Bytes& b)
{
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Bytes info_frame(std::uint64_t start, std::uint64_t end, std::uint64_t content_id = 77)
{
    wire::ModelInfo info;
    info.content_id = content_id;
    info.file_bytes = 100;
    info.start = start;
    info.end = end;
    return wire::encode(info);
}

Bytes data_frame(std::size_t count)
{
    return wire::make_frame(wire::FrameType::Data, Bytes(count, std::byte{5}));
}

Bytes done_frame(wire::DoneReason reason = wire::DoneReason::EndReached)
{
    return wire::encode(wire::Done{reason});
}

class TransferTest : public testing::Test
{
protected:
    TransferTest() : transfer({"cow", 240, 320, 16 << 20}) {}

    wire::Open open(const StopPlan& stop = {})
    {
        const auto frame = transfer.open(stop);
        EXPECT_TRUE(frame.has_value());
        const auto message = wire::parse_open(std::span(*frame).subspan(proto::kFrameHeaderBytes));
        EXPECT_TRUE(message.has_value());
        return message.value_or(wire::Open{});
    }

    Result<void> take(const Bytes& bytes)
    {
        return transfer.take(bytes, [this](std::span<const std::byte> piece) {
            payload += piece.size();
        });
    }

    ErrorCode error_of(const Bytes& bytes)
    {
        const auto taken = take(bytes);
        return taken ? ErrorCode::Ok : taken.error().code;
    }

    Transfer transfer;
    std::size_t payload = 0;
};

TEST_F(TransferTest, SaysWhoItIsAndWhatItWants)
{
    StopPlan stop;
    stop.condition.level = 3;
    stop.condition.error = 0.5;
    stop.error_in_percent = true;
    const wire::Open message = open(stop);
    EXPECT_EQ(message.model, "cow");
    EXPECT_EQ(message.client, "vsplit-pda");
    EXPECT_EQ(message.start, 0U);
    EXPECT_EQ(message.content_id, 0U);
    EXPECT_EQ(message.screen_width, 240);
    EXPECT_EQ(message.screen_height, 320);
    EXPECT_EQ(message.memory_bytes, 16U << 20);
    EXPECT_EQ(message.stop.level, 3U);
    EXPECT_DOUBLE_EQ(message.stop.error, 0.5);
    EXPECT_EQ(message.stop.error_unit, wire::ErrorUnit::DiagonalPercent);
}

TEST_F(TransferTest, AsksForEverythingWhenNoStopIsGiven)
{
    EXPECT_EQ(open().stop, wire::StopRequest{});
}

TEST_F(TransferTest, ReadsAConversationHoweverItIsCut)
{
    const Bytes all = wire::make_frame(wire::FrameType::Waiting) + info_frame(0, 60) +
                      data_frame(25) + data_frame(35) + done_frame();
    open();
    for (const std::byte byte : all)
    {
        EXPECT_FALSE(transfer.done());
        ASSERT_TRUE(take({byte}).has_value());
    }
    EXPECT_TRUE(transfer.done());
    EXPECT_EQ(payload, 60U);
    EXPECT_EQ(transfer.received(), 60U);
}

TEST_F(TransferTest, AsksForTheNextByteOfTheSameContentAfterALoss)
{
    open();
    // The connection ends inside a Data frame: 40 announced, 17 there.
    Bytes cut = info_frame(0, 60) + data_frame(40);
    cut.resize(cut.size() - 23);
    ASSERT_TRUE(take(cut).has_value());
    transfer.start_connection();
    const wire::Open again = open();
    EXPECT_EQ(again.start, 17U);
    EXPECT_EQ(again.content_id, 77U);
    ASSERT_TRUE(take(info_frame(17, 60) + data_frame(43) + done_frame()).has_value());
    EXPECT_TRUE(transfer.done());
    EXPECT_EQ(payload, 60U);
}

TEST_F(TransferTest, RefusesOtherContentAfterALoss)
{
    open();
    ASSERT_TRUE(take(info_frame(0, 60) + data_frame(10)).has_value());
    transfer.start_connection();
    open();
    EXPECT_EQ(error_of(info_frame(10, 60, 78)), ErrorCode::ContentChanged);
}

TEST_F(TransferTest, GoesOnAfterACancelWithAnEarlierStop)
{
    open();
    ASSERT_TRUE(take(info_frame(0, 60) + data_frame(10)).has_value());
    EXPECT_EQ(transfer.cancel(), wire::make_frame(wire::FrameType::Cancel));
    ASSERT_TRUE(take(data_frame(5) + done_frame(wire::DoneReason::Cancelled)).has_value());
    EXPECT_TRUE(transfer.done());
    StopPlan stop;
    stop.condition.level = 1;
    EXPECT_EQ(open(stop).start, 15U);
    // The earlier stop is behind what is here already: nothing more comes.
    ASSERT_TRUE(take(info_frame(15, 12) + done_frame()).has_value());
    EXPECT_TRUE(transfer.done());
    EXPECT_EQ(payload, 15U);
}

TEST_F(TransferTest, RefusesWhatBreaksTheProtocol)
{
    const std::vector<Bytes> conversations{
        data_frame(1),
        done_frame(),
        info_frame(3, 60),
        info_frame(0, 60) + info_frame(0, 60),
        info_frame(0, 60) + data_frame(61),
        info_frame(0, 60) + data_frame(60) + data_frame(1),
        info_frame(0, 60) + data_frame(59) + done_frame(),
        info_frame(0, 60) + done_frame(wire::DoneReason::Cancelled),
        info_frame(0, 60) + data_frame(60) + done_frame() + data_frame(1),
        info_frame(0, 60) + data_frame(60) + done_frame() + done_frame(),
        info_frame(0, 60) + wire::make_frame(wire::FrameType::Waiting),
        wire::make_frame(wire::FrameType::Pong, Bytes(8)),
    };
    for (std::size_t i = 0; i < conversations.size(); ++i)
    {
        transfer = Transfer({"cow", 240, 320, 0});
        open();
        EXPECT_EQ(error_of(conversations[i]), ErrorCode::BadRequest) << i;
    }
}

TEST_F(TransferTest, RefusesGarbage)
{
    open();
    EXPECT_EQ(error_of(Bytes(100, std::byte{0x55})), ErrorCode::BadFrame);
}

TEST_F(TransferTest, PassesOnWhatTheServerReports)
{
    open();
    const Bytes failure = wire::encode(wire::Failure{
        static_cast<std::uint16_t>(ErrorCode::NotFound), "no model cow", false});
    const auto taken = take(failure);
    ASSERT_FALSE(taken.has_value());
    EXPECT_EQ(taken.error().code, ErrorCode::NotFound);
    EXPECT_NE(taken.error().message.find("no model cow"), std::string::npos);
}

TEST_F(TransferTest, RefusesANameThatNoServerAccepts)
{
    Transfer other({std::string(256, 'x'), 1, 1, 1});
    const auto frame = other.open({});
    ASSERT_FALSE(frame.has_value());
    EXPECT_EQ(frame.error().code, ErrorCode::BadRequest);
}

TEST_F(TransferTest, LeavesOutRangesByAskingForWhatLiesBetween)
{
    transfer.leave_out({{30, 40}, {40, 55}, {80, 100}});
    wire::Open first = open();
    EXPECT_EQ(first.start, 0U);
    EXPECT_EQ(first.stop.bytes, 30U);
    ASSERT_TRUE(take(info_frame(0, 30) + data_frame(30) + done_frame()).has_value());
    EXPECT_TRUE(transfer.has_more());
    EXPECT_EQ(transfer.take_gaps(), (std::vector<ByteRange>{{30, 40}, {40, 55}}));
    EXPECT_TRUE(transfer.take_gaps().empty());
    wire::Open second = open();
    EXPECT_EQ(second.start, 55U);
    EXPECT_EQ(second.content_id, 77U);
    EXPECT_EQ(second.stop.bytes, 80U);
    ASSERT_TRUE(take(info_frame(55, 80) + data_frame(25) + done_frame()).has_value());
    EXPECT_FALSE(transfer.has_more()) << "nothing lies behind the last gap";
    EXPECT_EQ(transfer.take_gaps(), (std::vector<ByteRange>{{80, 100}}));
    EXPECT_EQ(payload, 55U);
    EXPECT_EQ(transfer.received(), 100U);
}

TEST_F(TransferTest, LeavesNothingOutOfWhatHasCome)
{
    open();
    ASSERT_TRUE(take(info_frame(0, 100) + data_frame(35)).has_value());
    transfer.leave_out({{10, 20}, {30, 40}, {60, 70}});
    static_cast<void>(transfer.cancel());
    ASSERT_TRUE(take(data_frame(5) + done_frame(wire::DoneReason::Cancelled)).has_value());
    EXPECT_TRUE(transfer.take_gaps().empty());
    EXPECT_EQ(open().stop.bytes, 60U);
}

TEST_F(TransferTest, EndsWhereTheServerStopsBeforeAGap)
{
    transfer.leave_out({{60, 70}});
    StopPlan stop;
    stop.condition.level = 2;
    open(stop);
    ASSERT_TRUE(take(info_frame(0, 50) + data_frame(50) + done_frame()).has_value());
    EXPECT_FALSE(transfer.has_more());
    EXPECT_TRUE(transfer.take_gaps().empty());
}

}  // namespace
}  // namespace vsplit::client
