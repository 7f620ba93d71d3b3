#include "core/byte_writer.h"
#include "image/code_stream.h"
#include "image/sample_raster.h"
#include "image/texture_decoder.h"
#include "image/texture_encoder.h"

#include <gtest/gtest.h>

#include <random>

namespace vsplit::image {
namespace {

using test::sample_raster;

const EncodedTexture& sample()
{
    static const EncodedTexture texture =
        *encode_texture(sample_raster(520, 300, 4), {.image = 3, .psnr = 36.0});
    return texture;
}

/// The first chunk of an image whose header is given, its runs being `runs`.
std::vector<std::byte> first_chunk(const TextureHeader& header, std::span<const std::byte> runs)
{
    ByteWriter writer;
    writer.write_varint(0);
    writer.write_varint(0);
    write_texture_header(header, writer);
    writer.write_bytes(runs);
    return writer.take();
}

constexpr TextureHeader kSmall{.width = 64, .height = 32, .channels = 3, .levels = 1, .layers = 2};

std::vector<std::byte> run(std::uint64_t count, std::uint64_t length, std::size_t bytes)
{
    ByteWriter writer;
    writer.write_varint(count);
    writer.write_varint(length);
    for (std::size_t i = 0; i < bytes; ++i)
    {
        writer.write(std::uint8_t{0x80});
    }
    return writer.take();
}

ErrorCode code_of(const std::vector<std::byte>& payload)
{
    TextureDecoder decoder;
    const auto result = decoder.feed(payload);
    EXPECT_EQ(decoder.header().has_value(), result.has_value());
    return result ? ErrorCode::Ok : result.error().code;
}

TEST(HostileTexture, RejectsEveryTruncationOfTheFirstChunk)
{
    const auto& payload = sample().chunks.front().payload;
    for (std::size_t length = 0; length < payload.size(); ++length)
    {
        TextureDecoder decoder;
        const auto result = decoder.feed(std::span(payload).first(length));
        // A chunk may end with any run: only there nothing is missing.
        EXPECT_TRUE(!result || decoder.picture(64)) << length;
        EXPECT_TRUE(length > 8 || !result) << length;
    }
}

TEST(HostileTexture, RefusesImpossibleHeaders)
{
    EXPECT_EQ(code_of(first_chunk(kSmall, run(6, 0, 0))), ErrorCode::Ok);
    for (const TextureHeader& header : {
             TextureHeader{.width = 0, .height = 1},
             TextureHeader{.width = 1, .height = 32769},
             TextureHeader{.width = 1, .height = 1, .levels = 10},
             TextureHeader{.width = 1, .height = 1, .layers = 0},
             TextureHeader{.width = 1, .height = 1, .layers = 65},
             TextureHeader{.width = 1, .height = 1, .channels = 2, .color_transform = true},
             TextureHeader{.width = 257, .height = 1, .levels = 0},
         })
    {
        EXPECT_EQ(code_of(first_chunk(header, run(1, 0, 0))), ErrorCode::BadChunk);
    }
}

TEST(HostileTexture, RefusesRunsThatDoNotFit)
{
    EXPECT_EQ(code_of(first_chunk(kSmall, {})), ErrorCode::Truncated);
    EXPECT_EQ(code_of(first_chunk(kSmall, run(0, 0, 0))), ErrorCode::BadChunk);
    EXPECT_EQ(code_of(first_chunk(kSmall, run(7, 0, 0))), ErrorCode::BadChunk);
    EXPECT_EQ(code_of(first_chunk(kSmall, run(2, 1, 1))), ErrorCode::BadChunk);
    EXPECT_EQ(code_of(first_chunk(kSmall, run(2, 9, 8))), ErrorCode::BadChunk);
    EXPECT_EQ(code_of(first_chunk(kSmall, run(2, ~std::uint64_t{0}, 8))), ErrorCode::BadChunk);
    auto twice = run(6, 0, 0);
    const auto rest = run(6, 0, 0);
    twice.insert(twice.end(), rest.begin(), rest.end());
    EXPECT_EQ(code_of(first_chunk(kSmall, twice)), ErrorCode::Ok);
    twice.insert(twice.end(), rest.begin(), rest.end());
    EXPECT_EQ(code_of(first_chunk(kSmall, twice)), ErrorCode::BadChunk);
}

TEST(HostileTexture, RefusesChunksOutOfOrderAndStaysAsItWas)
{
    const auto& chunks = sample().chunks;
    ASSERT_GE(chunks.size(), 3U);
    TextureDecoder decoder;
    EXPECT_EQ(decoder.picture(64).error().code, ErrorCode::Truncated);
    EXPECT_EQ(decoder.feed(chunks[1].payload).error().code, ErrorCode::BadChunk);
    ASSERT_TRUE(decoder.feed(chunks[0].payload));
    ASSERT_TRUE(decoder.feed(chunks[1].payload));
    const auto before = decoder.picture(520);
    EXPECT_EQ(decoder.feed(chunks[0].payload).error().code, ErrorCode::BadChunk);
    EXPECT_EQ(decoder.feed(chunks[1].payload).error().code, ErrorCode::BadChunk);
    EXPECT_EQ(*decoder.picture(520), *before);
    EXPECT_TRUE(decoder.feed(chunks[2].payload));
}

TEST(HostileTexture, RefusesChunksOfAnotherImage)
{
    const auto& chunks = sample().chunks;
    EXPECT_EQ(*texture_chunk_image(chunks[1].payload), 3U);
    TextureDecoder decoder;
    ASSERT_TRUE(decoder.feed(chunks[0].payload));
    auto other = chunks[1].payload;
    other[0] = std::byte{4};
    EXPECT_EQ(decoder.feed(other).error().code, ErrorCode::BadChunk);
}

TEST(HostileTexture, KeepsWithinItsLimits)
{
    const auto& chunks = sample().chunks;
    TextureDecoder few_bytes({.max_coded_bytes = chunks[0].payload.size()});
    ASSERT_TRUE(few_bytes.feed(chunks[0].payload));
    EXPECT_EQ(few_bytes.feed(chunks[2].payload).error().code, ErrorCode::LimitExceeded);
    TextureDecoder few_pixels({.max_pixels = 260 * 150});
    ASSERT_TRUE(few_pixels.feed(chunks[0].payload));
    EXPECT_EQ(few_pixels.picture(520).error().code, ErrorCode::LimitExceeded);
}

TEST(HostileTexture, SurvivesNoiseInPackets)
{
    std::mt19937 random(7);
    for (int round = 0; round < 60; ++round)
    {
        TextureDecoder decoder;
        for (const TextureChunk& chunk : sample().chunks)
        {
            auto payload = chunk.payload;
            for (int i = 0; i < 3; ++i)
            {
                payload[10 + random() % (payload.size() - 10)] = std::byte(random() & 255U);
            }
            static_cast<void>(decoder.feed(payload));
        }
        const auto picture = decoder.picture(520);
        EXPECT_TRUE(
            picture || picture.error().code == ErrorCode::BadChunk ||
            picture.error().code == ErrorCode::Truncated
        );
    }
}

TEST(CodeStream, IsTheOneThatOpenJpegWrites)
{
    // encode_texture() compares them; sizes, levels and both wavelets matter.
    for (const std::uint32_t side : {1U, 3U, 49U, 130U})
    {
        for (std::uint8_t channels = 1; channels <= 4; ++channels)
        {
            for (const bool lossless : {false, true})
            {
                const auto texture = encode_texture(
                    sample_raster(side, side / 2 + 1, channels), {.lossless = lossless}
                );
                EXPECT_TRUE(texture) << texture.error().message;
            }
        }
    }
}

}  // namespace
}  // namespace vsplit::image
