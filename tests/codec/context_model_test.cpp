#include "codec/context_model.h"

#include "codec/entropy_coder.h"
#include "core/byte_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace vsplit::test {
namespace {

using codec::BitDecoder;
using codec::BitEncoder;
using codec::IntegerModel;
using codec::kMaxCodedInteger;

std::vector<std::byte> encode_integers(const std::vector<std::int32_t>& values)
{
    BitEncoder bits;
    IntegerModel model;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        EXPECT_EQ(codec::code_integer(bits, model, values[i], i % 3), values[i]);
    }
    ByteWriter out;
    bits.finish(out);
    return out.take();
}

void expect_round_trip(const std::vector<std::int32_t>& values)
{
    const auto bytes = encode_integers(values);
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    IntegerModel model;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        ASSERT_EQ(codec::code_integer(bits, model, 0, i % 3), values[i]) << "number " << i;
    }
    EXPECT_TRUE(bits.finish().has_value());
}

TEST(IntegerModel, GivesBackExtremeValues)
{
    std::vector<std::int32_t> values;
    for (int exponent = 0; exponent < 24; ++exponent)
    {
        for (const std::int32_t offset : {-1, 0, 1})
        {
            const std::int32_t value =
                std::min((std::int32_t{1} << exponent) + offset, kMaxCodedInteger);
            values.push_back(value);
            values.push_back(-value);
        }
    }
    values.push_back(kMaxCodedInteger);
    values.push_back(-kMaxCodedInteger);
    expect_round_trip(values);
}

TEST(IntegerModel, GivesBackRandomValuesOfEveryMagnitude)
{
    std::mt19937 random(17);
    std::vector<std::int32_t> values(5000);
    for (std::int32_t& value : values)
    {
        const int bits = static_cast<int>(random() % 25);
        value = static_cast<std::int32_t>(random() & ((1U << bits) - 1U));
        value = random() % 2 == 0 ? value : -value;
    }
    expect_round_trip(values);
}

TEST(IntegerModel, LearnsWhatIsCommon)
{
    const std::vector<std::int32_t> same(2000, -3);
    EXPECT_LT(encode_integers(same).size(), 100U);
    expect_round_trip(same);
}

TEST(AdaptiveBit, StaysCodableAfterAnyHistory)
{
    for (const bool usual : {false, true})
    {
        BitEncoder bits;
        codec::AdaptiveBit model;
        for (int i = 0; i < 10000; ++i)
        {
            codec::code_bit(bits, model, usual);
        }
        codec::code_bit(bits, model, !usual);
        ByteWriter out;
        bits.finish(out);
        BitDecoder decoder;
        ASSERT_TRUE(decoder.start(out.view()).has_value());
        codec::AdaptiveBit learned;
        for (int i = 0; i < 10000; ++i)
        {
            ASSERT_EQ(codec::code_bit(decoder, learned, false), usual);
        }
        EXPECT_EQ(codec::code_bit(decoder, learned, false), !usual);
        EXPECT_TRUE(decoder.finish().has_value());
    }
}

TEST(LogisticModel, GivesBackBitsWhateverTheWeightsAre)
{
    // Weights at the ends of their range wrap round instead of overflowing.
    for (const std::int32_t start : {0, 1 << 20, -(1 << 30), 2147483647, -2147483647 - 1})
    {
        SCOPED_TRACE(start);
        std::mt19937 random(5);
        std::vector<bool> values(500);
        for (auto value : values)
        {
            value = random() % 4 == 0;
        }
        const auto run = [&](auto& coder, std::vector<bool>& out) {
            std::array<std::int32_t, 3> weights{start, start, start};
            const std::array<std::int32_t*, 3> used{&weights[0], &weights[1], &weights[2]};
            for (const bool value : values)
            {
                out.push_back(codec::code_logistic(coder, used, value, 4000));
            }
        };
        BitEncoder encoder;
        std::vector<bool> written;
        run(encoder, written);
        ByteWriter out;
        encoder.finish(out);
        BitDecoder decoder;
        ASSERT_TRUE(decoder.start(out.view()).has_value());
        std::vector<bool> read;
        run(decoder, read);
        EXPECT_EQ(read, values);
        EXPECT_TRUE(decoder.finish().has_value());
    }
}

TEST(Squash, IsMonotoneSymmetricAndNeverCertain)
{
    for (std::int32_t score = -5000; score < 5000; ++score)
    {
        EXPECT_LE(codec::squash(score), codec::squash(score + 1));
        EXPECT_GE(codec::squash(score), 48U);
        EXPECT_LE(codec::squash(score), 65488U);
    }
    EXPECT_EQ(codec::squash(0), 32768U);
    for (std::int32_t score = 0; score < 2047; ++score)
    {
        EXPECT_NEAR(codec::squash(score) + codec::squash(-score), 65536U, 1.0);
    }
}

TEST(LogSum, IsWithinAHalfStepOfTheLogarithm)
{
    for (std::int32_t a = -3000; a <= 3000; a += 37)
    {
        for (std::int32_t b = -3000; b <= 3000; b += 41)
        {
            const double exact = 256.0 * std::log(std::exp(a / 256.0) + std::exp(b / 256.0));
            EXPECT_NEAR(codec::log_sum(a, b), exact, 3.0) << a << ' ' << b;
        }
    }
}

}  // namespace
}  // namespace vsplit::test
