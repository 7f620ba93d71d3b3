#include "codec/entropy_coder.h"

#include "core/byte_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace vsplit::test {
namespace {

using codec::BitDecoder;
using codec::BitEncoder;

/// One call of the coder: a modelled bit, or raw bits when `raw_bits` is not negative.
struct Operation
{
    int raw_bits = -1;
    std::uint32_t probability = 32768;
    std::uint32_t value = 0;
};

std::vector<Operation> random_operations(std::size_t count, double raw_share, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<Operation> operations(count);
    for (Operation& operation : operations)
    {
        if (static_cast<double>(random() % 1000) < raw_share * 1000.0)
        {
            operation.raw_bits = static_cast<int>(random() % 25);
            operation.value = static_cast<std::uint32_t>(random()) &
                              ((std::uint32_t{1} << operation.raw_bits) - 1U);
        }
        else
        {
            operation.probability = static_cast<std::uint32_t>(random() % 65537);
            operation.value = random() % 65536 < operation.probability ? 1U : 0U;
        }
    }
    return operations;
}

std::vector<std::byte> encode(BitEncoder& bits, const std::vector<Operation>& operations)
{
    for (const Operation& operation : operations)
    {
        if (operation.raw_bits >= 0)
        {
            EXPECT_EQ(bits.raw(operation.value, operation.raw_bits), operation.value);
        }
        else
        {
            EXPECT_EQ(bits.bit(operation.probability, operation.value != 0), operation.value != 0);
        }
    }
    ByteWriter out;
    bits.finish(out);
    return out.take();
}

std::vector<std::byte> encode(const std::vector<Operation>& operations)
{
    BitEncoder bits;
    return encode(bits, operations);
}

/// Counts the operations that come back as they went in.
std::size_t count_equal(BitDecoder& bits, const std::vector<Operation>& operations)
{
    std::size_t equal = 0;
    for (const Operation& operation : operations)
    {
        const std::uint32_t value = operation.raw_bits >= 0
                                        ? bits.raw(0, operation.raw_bits)
                                        : std::uint32_t{bits.bit(operation.probability)};
        equal += value == operation.value ? 1 : 0;
    }
    return equal;
}

class BitCoder : public ::testing::TestWithParam<double>
{
};

TEST_P(BitCoder, GivesBackEveryBitAtRandomProbabilities)
{
    for (const std::size_t count : {1U, 2U, 3U, 17U, 1000U, 20000U})
    {
        SCOPED_TRACE(count);
        const auto operations = random_operations(count, GetParam(), 7);
        const auto bytes = encode(operations);
        BitDecoder bits;
        ASSERT_TRUE(bits.start(bytes).has_value());
        EXPECT_EQ(count_equal(bits, operations), count);
        EXPECT_TRUE(bits.finish().has_value());
    }
}

INSTANTIATE_TEST_SUITE_P(RawShares, BitCoder, ::testing::Values(0.0, 0.3, 1.0));

TEST(BitCoder, SpendsLittleOnWhatIsLikely)
{
    std::vector<Operation> operations(8000, Operation{.probability = 65300, .value = 1});
    EXPECT_LT(encode(operations).size(), 30U);  // 8000 * 0.0056 bits = 6 bytes
    for (Operation& operation : operations)
    {
        operation.probability = 32768;
    }
    EXPECT_NEAR(static_cast<double>(encode(operations).size()), 1000.0, 10.0);
}

TEST(BitCoder, CodesTheLeastLikelyBitsToo)
{
    std::vector<Operation> operations;
    for (const std::uint32_t probability : {0U, 1U, 48U, 65488U, 65535U, 65536U})
    {
        operations.push_back({.probability = probability, .value = 1});
        operations.push_back({.probability = probability, .value = 0});
    }
    const auto bytes = encode(operations);
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_EQ(count_equal(bits, operations), operations.size());
    EXPECT_TRUE(bits.finish().has_value());
}

TEST(BitCoder, WorksWithoutAnyBit)
{
    const auto bytes = encode({});
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_TRUE(bits.finish().has_value());
}

TEST(BitEncoder, ForgetsItsBitsWhenTheyAreWritten)
{
    const auto operations = random_operations(500, 0.2, 3);
    BitEncoder bits;
    const auto first = encode(bits, operations);
    EXPECT_EQ(encode(bits, operations), first);
    EXPECT_EQ(encode(bits, {}), encode({}));
}

TEST(BitEncoder, KeepsOnlyTheLowBitsOfARawValue)
{
    BitEncoder bits;
    EXPECT_EQ(bits.raw(0xFFFFFFFF, 3), 7U);
    EXPECT_EQ(bits.raw(0xFFFFFFFF, 0), 0U);
    ByteWriter out;
    bits.finish(out);
    BitDecoder decoder;
    ASSERT_TRUE(decoder.start(out.view()).has_value());
    EXPECT_EQ(decoder.raw(0, 3), 7U);
    EXPECT_EQ(decoder.raw(0, 0), 0U);
    EXPECT_TRUE(decoder.finish().has_value());
}

TEST(BitDecoder, ReportsBitsThatNobodyRead)
{
    const auto operations = random_operations(300, 0.0, 11);
    const auto bytes = encode(operations);
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    const std::vector<Operation> some(operations.begin(), operations.begin() + 150);
    ASSERT_EQ(count_equal(bits, some), some.size());
    const auto finished = bits.finish();
    ASSERT_FALSE(finished.has_value());
    EXPECT_EQ(finished.error().code, ErrorCode::BadChunk);
}

TEST(BitDecoder, ReportsRawBytesThatNobodyRead)
{
    const auto bytes = encode({{.raw_bits = 8, .value = 1}, {.raw_bits = 8, .value = 2}});
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_EQ(bits.raw(0, 8), 1U);
    EXPECT_FALSE(bits.finish().has_value());
}

TEST(BitDecoder, ReportsRawBitsBeyondTheEnd)
{
    const auto bytes = encode({{.raw_bits = 4, .value = 5}});
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_EQ(bits.raw(0, 4), 5U);
    EXPECT_EQ(bits.raw(0, 24), 0U);
    EXPECT_FALSE(bits.finish().has_value());
}

TEST(BitDecoder, ReportsModelledBitsBeyondTheEnd)
{
    const auto bytes = encode(random_operations(50, 0.0, 2));
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    for (int i = 0; i < 5000; ++i)
    {
        static_cast<void>(bits.bit(20000));
    }
    EXPECT_FALSE(bits.finish().has_value());
}

TEST(BitDecoder, ReportsPaddingThatIsNotZero)
{
    auto bytes = encode({{.raw_bits = 3, .value = 5}});
    bytes[0] |= std::byte{0x40};
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_EQ(bits.raw(0, 3), 5U);
    EXPECT_FALSE(bits.finish().has_value());
}

TEST(BitDecoder, ReportsBitsThatWereReadTwice)
{
    // Raw bits are read from the front, modelled ones from the end: neither may reach into the other.
    const auto operations = random_operations(100, 0.0, 5);
    auto bytes = encode(operations);
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_EQ(count_equal(bits, operations), operations.size());
    EXPECT_FALSE(bits.exhausted());
    static_cast<void>(bits.raw(0, 8));
    EXPECT_TRUE(bits.exhausted());
    EXPECT_FALSE(bits.finish().has_value());

    bytes.insert(bytes.begin(), std::byte{0});
    ASSERT_TRUE(bits.start(bytes).has_value());
    EXPECT_EQ(count_equal(bits, operations), operations.size());
    EXPECT_FALSE(bits.finish().has_value());
    EXPECT_EQ(bits.raw(0, 8), 0U);
    EXPECT_TRUE(bits.finish().has_value());
}

TEST(BitDecoder, KnowsWhenItsBitsAreExhausted)
{
    const auto operations = random_operations(50, 0.0, 2);
    const auto bytes = encode(operations);
    BitDecoder bits;
    ASSERT_TRUE(bits.start(bytes).has_value());
    for (const Operation& operation : operations)
    {
        EXPECT_FALSE(bits.exhausted());
        static_cast<void>(bits.bit(operation.probability));
    }
    for (int i = 0; i < 50; ++i)
    {
        static_cast<void>(bits.bit(20000));
    }
    EXPECT_TRUE(bits.exhausted());
}

TEST(BitDecoder, RejectsWhatCannotStart)
{
    BitDecoder bits;
    EXPECT_EQ(bits.start({}).error().code, ErrorCode::BadChunk);
    const std::vector<std::byte> wrong{std::byte{0}, std::byte{0xC0}};
    EXPECT_EQ(bits.start(wrong).error().code, ErrorCode::BadChunk);
}

TEST(BitDecoder, RejectsEveryTruncationOrReadsToItsEnd)
{
    const auto operations = random_operations(200, 0.2, 5);
    const auto bytes = encode(operations);
    for (std::size_t length = 0; length < bytes.size(); ++length)
    {
        BitDecoder bits;
        if (bits.start(std::span(bytes).first(length)).has_value())
        {
            static_cast<void>(count_equal(bits, operations));
            EXPECT_FALSE(bits.finish().has_value()) << length << " of " << bytes.size();
        }
    }
}

}  // namespace
}  // namespace vsplit::test
