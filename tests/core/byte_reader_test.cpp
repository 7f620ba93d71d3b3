#include "core/byte_reader.h"

#include "core/byte_writer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vsplit {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> values)
{
    std::vector<std::byte> bytes;
    for (const int value : values)
    {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

TEST(ByteWriter, WritesLittleEndian)
{
    ByteWriter writer;
    writer.write(std::uint8_t{0x01});
    writer.write(std::uint16_t{0x2345});
    writer.write(std::uint32_t{0x6789ABCD});
    EXPECT_EQ(writer.take(), bytes_of({0x01, 0x45, 0x23, 0xCD, 0xAB, 0x89, 0x67}));
}

TEST(ByteWriter, IsEmptyAfterTake)
{
    ByteWriter writer;
    writer.write(std::uint32_t{1});
    static_cast<void>(writer.take());
    EXPECT_EQ(writer.size(), 0U);
}

TEST(ByteReader, ReadsBackEveryFieldType)
{
    ByteWriter writer;
    writer.write(std::uint8_t{200});
    writer.write(std::uint16_t{60000});
    writer.write(std::uint32_t{4'000'000'000U});
    writer.write(std::numeric_limits<std::uint64_t>::max());
    writer.write_f64(-0.1);
    writer.write_bytes(bytes_of({9, 8}));
    const auto bytes = writer.take();

    ByteReader reader(bytes);
    EXPECT_EQ(reader.read<std::uint8_t>(), 200U);
    EXPECT_EQ(reader.read<std::uint16_t>(), 60000U);
    EXPECT_EQ(reader.read<std::uint32_t>(), 4'000'000'000U);
    EXPECT_EQ(reader.read<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(reader.read_f64(), -0.1);
    const auto tail = reader.read_bytes(2);
    ASSERT_TRUE(tail.has_value());
    EXPECT_EQ((*tail)[1], std::byte{8});
    EXPECT_EQ(reader.remaining(), 0U);
}

TEST(ByteReader, ReportsTheOffsetAtWhichDataEnd)
{
    const auto bytes = bytes_of({1, 2, 3, 4, 5});
    ByteReader reader(bytes, 1000);
    ASSERT_TRUE(reader.read<std::uint32_t>().has_value());
    const auto result = reader.read<std::uint16_t>();
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::Truncated);
    EXPECT_EQ(result.error().offset, 1004U);
}

TEST(ByteReader, KeepsItsPlaceAfterAFailedRead)
{
    const auto bytes = bytes_of({7, 8});
    ByteReader reader(bytes);
    EXPECT_FALSE(reader.read<std::uint32_t>().has_value());
    EXPECT_FALSE(reader.read_bytes(3).has_value());
    EXPECT_EQ(reader.read<std::uint16_t>(), 0x0807U);
}

TEST(ByteReader, RefusesACountNearTheSizeLimit)
{
    const auto bytes = bytes_of({1, 2, 3});
    ByteReader reader(bytes);
    ASSERT_TRUE(reader.read<std::uint8_t>().has_value());
    EXPECT_FALSE(reader.read_bytes(std::numeric_limits<std::size_t>::max()).has_value());
}

TEST(Varint, RoundTripsAtEveryLengthBoundary)
{
    std::vector<std::uint64_t> values{0, std::numeric_limits<std::uint64_t>::max()};
    for (int bits = 7; bits < 64; bits += 7)
    {
        values.push_back((std::uint64_t{1} << bits) - 1);
        values.push_back(std::uint64_t{1} << bits);
    }
    ByteWriter writer;
    for (const auto value : values)
    {
        writer.write_varint(value);
    }
    const auto bytes = writer.take();
    ByteReader reader(bytes);
    for (const auto value : values)
    {
        EXPECT_EQ(reader.read_varint(), value);
    }
    EXPECT_EQ(reader.remaining(), 0U);
}

TEST(Varint, UsesOneByteBelow128AndTenForTheLargest)
{
    ByteWriter writer;
    writer.write_varint(127);
    EXPECT_EQ(writer.size(), 1U);
    writer.write_varint(std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(writer.size(), 11U);
}

TEST(Varint, RefusesMoreThan64Bits)
{
    const auto eleven = std::vector<std::byte>(11, std::byte{0xFF});
    ByteReader reader(eleven);
    EXPECT_EQ(reader.read_varint().error().code, ErrorCode::BadHeader);

    auto too_large = std::vector<std::byte>(9, std::byte{0xFF});
    too_large.push_back(std::byte{2});
    ByteReader second(too_large);
    EXPECT_EQ(second.read_varint().error().code, ErrorCode::BadHeader);
}

TEST(Varint, RefusesEveryTruncation)
{
    ByteWriter writer;
    writer.write_varint(std::numeric_limits<std::uint64_t>::max());
    const auto bytes = writer.take();
    for (std::size_t length = 0; length < bytes.size(); ++length)
    {
        ByteReader reader(std::span<const std::byte>(bytes).first(length));
        EXPECT_EQ(reader.read_varint().error().code, ErrorCode::Truncated) << length;
    }
}

}  // namespace
}  // namespace vsplit
