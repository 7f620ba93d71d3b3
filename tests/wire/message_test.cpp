#include "wire/message.h"

#include "wire/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace vsplit::wire {
namespace {

using Bytes = std::vector<std::byte>;

Bytes payload_of(const Bytes& frame)
{
    return Bytes(frame.begin() + proto::kFrameHeaderBytes, frame.end());
}

Open full_open()
{
    return Open{
        .model = "scans/bunny \xC3\xA9",
        .client = "vsplit-pda 0.1",
        .min_version = 1,
        .max_version = 3,
        .start = 123'456'789'012,
        .content_id = 0xFEDCBA9876543210U,
        .stop =
            {.level = 7,
             .bytes = 1'000'000,
             .faces = 5000,
             .error = 0.125,
             .error_unit = ErrorUnit::DiagonalPercent},
        .screen_width = 320,
        .screen_height = 240,
        .memory_bytes = 64U << 20U,
        .max_texture_size = 1024,
    };
}

ModelInfo full_info()
{
    return ModelInfo{
        .version = 2,
        .content_id = 0x1122334455667788U,
        .file_bytes = 5'000'000'000,
        .start = 4,
        .end = 4'000'000'000,
    };
}

Bytes open_payload(const Open& open)
{
    const auto frame = encode(open);
    EXPECT_TRUE(frame) << describe(frame.error());
    return payload_of(*frame);
}

/// Every prefix of a payload must be refused by its own parser.
template <typename Parser>
void expect_every_truncation_refused(const Bytes& payload, Parser parse)
{
    for (std::size_t length = 0; length < payload.size(); ++length)
    {
        const auto message = parse(std::span(payload).first(length));
        ASSERT_FALSE(message) << length << " of " << payload.size();
        EXPECT_EQ(message.error().code, ErrorCode::BadRequest);
    }
}

TEST(Message, OpenComesBackAsItWasSent)
{
    const auto parsed = parse_open(open_payload(full_open()));
    ASSERT_TRUE(parsed) << describe(parsed.error());
    EXPECT_EQ(*parsed, full_open());
}

TEST(Message, SmallestOpenMeansTheWholeModel)
{
    const auto parsed = parse_open(open_payload(Open{.model = "m"}));
    ASSERT_TRUE(parsed) << describe(parsed.error());
    EXPECT_EQ(*parsed, Open{.model = "m"});
    EXPECT_EQ(parsed->stop.bytes, std::numeric_limits<std::uint64_t>::max());
}

TEST(Message, AnswersComeBackAsTheyWereSent)
{
    const auto info = parse_model_info(payload_of(encode(full_info())));
    ASSERT_TRUE(info) << describe(info.error());
    EXPECT_EQ(*info, full_info());
    for (const DoneReason reason : {DoneReason::EndReached, DoneReason::Cancelled})
    {
        const auto done = parse_done(payload_of(encode(Done{reason})));
        ASSERT_TRUE(done) << describe(done.error());
        EXPECT_EQ(done->reason, reason);
    }
    const Failure failure{40, "there is no model 'x'", true};
    const auto parsed = parse_failure(payload_of(encode(failure)));
    ASSERT_TRUE(parsed) << describe(parsed.error());
    EXPECT_EQ(*parsed, failure);
}

TEST(Message, AnswersOfOneTransferStayWithinTheirBudget)
{
    const ModelInfo info{
        .content_id = ~0ULL, .file_bytes = 1ULL << 40U, .start = 0, .end = 1ULL << 39U};
    const std::size_t data_header = proto::kFrameHeaderBytes;
    EXPECT_LE(encode(info).size() + data_header + encode(Done{}).size(), 64U);
}

TEST(Message, EveryTruncationIsRefused)
{
    expect_every_truncation_refused(open_payload(full_open()), parse_open);
    expect_every_truncation_refused(payload_of(encode(full_info())), parse_model_info);
    expect_every_truncation_refused(payload_of(encode(Done{DoneReason::Cancelled})), parse_done);
    expect_every_truncation_refused(payload_of(encode(Failure{40, "no", true})), parse_failure);
}

TEST(Message, TrailingBytesAreTheNewFieldsOfALaterVersion)
{
    Bytes payload = open_payload(full_open());
    payload.resize(payload.size() + 8, std::byte{0x5A});
    const auto parsed = parse_open(payload);
    ASSERT_TRUE(parsed) << describe(parsed.error());
    EXPECT_EQ(*parsed, full_open());
    payload.resize(payload.size() + 1);
    EXPECT_FALSE(parse_open(payload));
}

TEST(Message, EqualMessagesAreEqualBytes)
{
    EXPECT_EQ(*encode(full_open()), *encode(full_open()));
    EXPECT_EQ(encode(full_info()), encode(full_info()));
}

TEST(Message, DamagedBytesNeverYieldFieldsOutOfRange)
{
    const Bytes good = open_payload(full_open());
    std::mt19937 random(20);
    for (int round = 0; round < 20'000; ++round)
    {
        Bytes bad = good;
        for (unsigned hits = 1 + random() % 4; hits > 0; --hits)
        {
            bad[random() % bad.size()] = static_cast<std::byte>(random());
        }
        const auto parsed = parse_open(bad);
        if (!parsed)
        {
            EXPECT_EQ(parsed.error().code, ErrorCode::BadRequest);
            continue;
        }
        EXPECT_TRUE(encode(*parsed)) << "round " << round;
    }
}

TEST(Message, OpenOutOfRangeIsRefusedBeforeItIsSent)
{
    const auto refused = [](auto change) {
        Open open = full_open();
        change(open);
        const auto frame = encode(open);
        return !frame && frame.error().code == ErrorCode::BadRequest;
    };
    EXPECT_TRUE(refused([](Open& open) { open.model.clear(); }));
    EXPECT_TRUE(refused([](Open& open) { open.model = std::string(256, 'm'); }));
    EXPECT_TRUE(refused([](Open& open) { open.model = "a\nb"; }));
    EXPECT_TRUE(refused([](Open& open) { open.model = std::string("a\0b", 3); }));
    EXPECT_TRUE(refused([](Open& open) { open.model = "\xFF\xFE"; }));
    EXPECT_TRUE(refused([](Open& open) { open.client = std::string(256, 'c'); }));
    EXPECT_TRUE(refused([](Open& open) { open.min_version = 0; }));
    EXPECT_TRUE(refused([](Open& open) { open.min_version = 4; }));
    EXPECT_TRUE(refused([](Open& open) { open.stop.error = -1.0; }));
    EXPECT_TRUE(refused([](Open& open) { open.stop.error = std::nan(""); }));
    EXPECT_TRUE(refused([](Open& open) { open.stop.error = HUGE_VAL; }));
    EXPECT_TRUE(refused([](Open& open) { open.stop.error_unit = static_cast<ErrorUnit>(2); }));
    EXPECT_TRUE(refused([](Open& open) { open.content_id = 0; }));
}

TEST(Message, ContradictingModelInfoIsRefused)
{
    const auto refused = [](auto change) {
        ModelInfo info = full_info();
        change(info);
        return !parse_model_info(payload_of(encode(info)));
    };
    EXPECT_FALSE(refused([](ModelInfo&) {}));
    EXPECT_TRUE(refused([](ModelInfo& info) { info.end = info.file_bytes + 1; }));
    EXPECT_TRUE(refused([](ModelInfo& info) { info.start = info.file_bytes + 1; }));
    EXPECT_TRUE(refused([](ModelInfo& info) { info.content_id = 0; }));
    EXPECT_TRUE(refused([](ModelInfo& info) { info.version = 0; }));
}

TEST(Message, FailureTextIsMadePrintableAndShort)
{
    const auto sent = encode(Failure{66, "bad\r\n\x01" + std::string(400, 'x'), false});
    const auto parsed = parse_failure(payload_of(sent));
    ASSERT_TRUE(parsed) << describe(parsed.error());
    EXPECT_EQ(parsed->message, "bad???" + std::string(249, 'x'));
    EXPECT_FALSE(parse_failure(payload_of(encode(Failure{0, "no code", false}))));
}

TEST(Message, UnknownFailureCodesBecomeInternalAndKeepTheirNumber)
{
    EXPECT_EQ(to_error(Failure{40, "gone", false}).code, ErrorCode::NotFound);
    const Error unknown = to_error(Failure{1234, "news", false});
    EXPECT_EQ(unknown.code, ErrorCode::Internal);
    EXPECT_NE(unknown.message.find("1234"), std::string::npos);
}

TEST(Message, VersionsThatDoNotMeetAreRefused)
{
    Open open{.model = "m"};
    EXPECT_EQ(negotiate_version(open).value(), 1);
    open.max_version = 9;
    EXPECT_EQ(negotiate_version(open).value(), 1);
    open.min_version = 2;
    ASSERT_FALSE(negotiate_version(open));
    EXPECT_EQ(negotiate_version(open).error().code, ErrorCode::UnsupportedVersion);
}

TEST(Message, TextMustBeWellFormedUtf8WithoutControls)
{
    EXPECT_TRUE(is_valid_text(""));
    EXPECT_TRUE(is_valid_text("\xE4\xBD\xA0\xF0\x9F\x90\x87"));
    EXPECT_FALSE(is_valid_text("\xE4\xBD"));          // cut
    EXPECT_FALSE(is_valid_text("\xC0\xAF"));          // overlong '/'
    EXPECT_FALSE(is_valid_text("\xED\xA0\x80"));      // surrogate
    EXPECT_FALSE(is_valid_text("\xF4\x90\x80\x80"));  // above U+10FFFF
    EXPECT_FALSE(is_valid_text("\x7F"));
    EXPECT_FALSE(is_valid_text("\xC2\x85"));  // C1 control
    EXPECT_FALSE(is_valid_text(std::string(256, 'a')));
}

TEST(ContentId, IsFnv1aOfTheHeader)
{
    EXPECT_EQ(content_id({}), 0xCBF29CE484222325U);
    const std::string text = "foobar";
    EXPECT_EQ(content_id(std::as_bytes(std::span(text))), 0x85944171F73967E8U);
}

}  // namespace
}  // namespace vsplit::wire
