#include "wire/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace vsplit::wire {
namespace {

using Bytes = std::vector<std::byte>;

struct Received
{
    FrameType type;
    Bytes payload;

    friend bool operator==(const Received&, const Received&) = default;
};

Bytes bytes_of(std::size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    Bytes bytes(count);
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::byte>(random()); });
    return bytes;
}

void append(Bytes& to, const Bytes& more)
{
    to.insert(to.end(), more.begin(), more.end());
}

/// Feeds `input` in pieces of `step` bytes; neighbouring Data pieces are joined.
Result<std::vector<Received>> receive(
    FrameParser& parser, std::span<const std::byte> input, std::size_t step
)
{
    std::vector<Received> frames;
    while (!input.empty())
    {
        auto piece = input.first(std::min(step, input.size()));
        input = input.subspan(piece.size());
        while (true)
        {
            const auto frame = parser.next(piece);
            VSPLIT_TRY(frame);
            if (!*frame)
            {
                break;
            }
            const Bytes payload((*frame)->payload.begin(), (*frame)->payload.end());
            const bool data = (*frame)->type == FrameType::Data;
            if (data && !frames.empty() && frames.back().type == FrameType::Data)
            {
                append(frames.back().payload, payload);
                continue;
            }
            frames.push_back({(*frame)->type, payload});
        }
        EXPECT_TRUE(piece.empty());
    }
    return frames;
}

ErrorCode code_of_header(Sender sender, std::uint32_t header)
{
    Bytes bytes;
    for (int shift = 0; shift < 32; shift += 8)
    {
        bytes.push_back(static_cast<std::byte>(header >> shift));
    }
    FrameParser parser(sender);
    std::span<const std::byte> input(bytes);
    const auto frame = parser.next(input);
    return frame ? ErrorCode::Ok : frame.error().code;
}

TEST(Frame, HeaderHoldsLengthBelowAndTypeAbove)
{
    const auto header = frame_header(FrameType::Data, 0x012345);
    EXPECT_THAT(
        header,
        testing::ElementsAre(std::byte{0x45}, std::byte{0x23}, std::byte{0x01}, std::byte{0x82})
    );
}

TEST(FrameParser, GivesBackWhatWasFramedHoweverTheBytesAreCut)
{
    const Bytes info = bytes_of(48, 1);
    const Bytes data = bytes_of(20'000, 2);
    const Bytes pong = bytes_of(8, 3);
    Bytes wire = make_frame(FrameType::ModelInfo, info);
    append(wire, make_frame(FrameType::Data, std::span(data).first(16'384)));
    append(wire, make_frame(FrameType::Data, std::span(data).subspan(16'384)));
    append(wire, make_frame(FrameType::Waiting));
    append(wire, make_frame(FrameType::Pong, pong));
    const std::vector<Received> expected{
        {FrameType::ModelInfo, info},
        {FrameType::Data, data},
        {FrameType::Waiting, {}},
        {FrameType::Pong, pong},
    };
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}, std::size_t{4096}, wire.size()})
    {
        FrameParser parser(Sender::Server);
        const auto frames = receive(parser, wire, step);
        ASSERT_TRUE(frames) << describe(frames.error());
        EXPECT_EQ(*frames, expected) << "pieces of " << step << " bytes";
        EXPECT_TRUE(parser.at_boundary());
    }
}

TEST(FrameParser, HandsOutDataBeforeTheFrameIsComplete)
{
    const Bytes wire = make_frame(FrameType::Data, bytes_of(1000, 4));
    FrameParser parser(Sender::Server);
    auto input = std::span<const std::byte>(wire).first(10);
    const auto frame = parser.next(input);
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->payload.size(), 6U);
    EXPECT_FALSE(parser.at_boundary());
}

TEST(FrameParser, EveryTruncationGivesNoFrameAndIsNoticed)
{
    const Bytes wire = make_frame(FrameType::Open, bytes_of(64, 5));
    for (std::size_t length = 1; length < wire.size(); ++length)
    {
        FrameParser parser(Sender::Client);
        auto input = std::span<const std::byte>(wire).first(length);
        const auto frame = parser.next(input);
        ASSERT_TRUE(frame);
        EXPECT_FALSE(frame->has_value()) << length;
        EXPECT_FALSE(parser.at_boundary()) << length;
    }
}

TEST(FrameParser, NothingIsNoFrame)
{
    FrameParser parser(Sender::Client);
    std::span<const std::byte> input;
    const auto frame = parser.next(input);
    ASSERT_TRUE(frame);
    EXPECT_FALSE(frame->has_value());
    EXPECT_TRUE(parser.at_boundary());
}

TEST(FrameParser, RefusesOversizeFramesBeforeTheirPayload)
{
    EXPECT_EQ(code_of_header(Sender::Client, 0x01001000), ErrorCode::Ok);
    EXPECT_EQ(code_of_header(Sender::Client, 0x01001001), ErrorCode::BadFrame);
    EXPECT_EQ(code_of_header(Sender::Client, 0x01FFFFFF), ErrorCode::BadFrame);
    EXPECT_EQ(code_of_header(Sender::Server, 0x82010000), ErrorCode::Ok);
    EXPECT_EQ(code_of_header(Sender::Server, 0x82010001), ErrorCode::BadFrame);
}

TEST(FrameParser, RefusesEmptyOpenAndLoadedPause)
{
    EXPECT_EQ(code_of_header(Sender::Client, 0x01000000), ErrorCode::BadFrame);
    EXPECT_EQ(code_of_header(Sender::Client, 0x02000001), ErrorCode::BadFrame);
    EXPECT_EQ(code_of_header(Sender::Client, 0x05000007), ErrorCode::BadFrame);
    EXPECT_EQ(code_of_header(Sender::Server, 0x82000000), ErrorCode::BadFrame);
}

TEST(FrameParser, AcceptsOnlyTheTypesOfItsSender)
{
    for (std::uint32_t type = 0; type < 256; ++type)
    {
        const bool client = type >= 0x01 && type <= 0x05;
        const bool server = type >= 0x81 && type <= 0x86;
        const std::uint32_t length = type == 0x05 || type == 0x85 ? 8 : 4;
        const bool empty = (type >= 0x02 && type <= 0x04) || type == 0x86;
        const std::uint32_t header = (type << 24U) | (empty ? 0 : length);
        EXPECT_EQ(code_of_header(Sender::Client, header) == ErrorCode::Ok, client) << type;
        EXPECT_EQ(code_of_header(Sender::Server, header) == ErrorCode::Ok, server) << type;
    }
}

TEST(FrameParser, KeepsItsErrorAndTellsTheOffset)
{
    Bytes wire = make_frame(FrameType::Pause);
    append(wire, Bytes(8, std::byte{0xFF}));
    FrameParser parser(Sender::Client);
    std::span<const std::byte> input(wire);
    ASSERT_TRUE(parser.next(input));
    const auto first = parser.next(input);
    ASSERT_FALSE(first);
    EXPECT_EQ(first.error().code, ErrorCode::BadFrame);
    EXPECT_EQ(first.error().offset, 4U);
    const Bytes good = make_frame(FrameType::Pause);
    std::span<const std::byte> more(good);
    const auto second = parser.next(more);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::BadFrame);
    EXPECT_EQ(more.size(), good.size());
}

TEST(FrameParser, NoiseNeverYieldsMoreThanItHolds)
{
    for (unsigned seed = 0; seed < 200; ++seed)
    {
        const Bytes noise = bytes_of(2000, seed);
        FrameParser parser(seed % 2 == 0 ? Sender::Client : Sender::Server);
        std::span<const std::byte> input(noise);
        std::size_t given = 0;
        for (auto frame = parser.next(input); frame && *frame; frame = parser.next(input))
        {
            given += (*frame)->payload.size();
        }
        EXPECT_LE(given, noise.size()) << "seed " << seed;
    }
}

}  // namespace
}  // namespace vsplit::wire
