#include "core/byte_reader.h"
#include "core/file_io.h"
#include "format.h"
#include "image/downsample.h"
#include "image/sample_raster.h"
#include "image/texture_decoder.h"
#include "image/texture_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace vsplit::image {
namespace {

using test::sample_raster;
using test::squared_error;

EncodedTexture encoded(const Raster& raster, const TextureOptions& options = {})
{
    auto result = encode_texture(raster, options);
    EXPECT_TRUE(result) << result.error().message;
    return std::move(*result);
}

TextureDecoder fed(const EncodedTexture& texture)
{
    TextureDecoder decoder;
    for (const TextureChunk& chunk : texture.chunks)
    {
        const auto result = decoder.feed(chunk.payload);
        EXPECT_TRUE(result) << result.error().message;
    }
    return decoder;
}

double psnr(double error)
{
    return 10.0 * std::log10(255.0 * 255.0 / error);
}

TEST(Texture, ReachesTheQualityThatWasAskedFor)
{
    for (std::uint8_t channels = 1; channels <= 4; ++channels)
    {
        const Raster raster = sample_raster(300, 200, channels);
        const auto texture = encoded(
            raster,
            {.psnr = 38.0,
             .cheap_bits_per_pixel = 0.0,
             .small_bits_per_pixel = 0.0,
             .exact_bytes = 0}
        );
        const auto picture = fed(texture).picture(4096);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_EQ(picture->channels, channels);
        EXPECT_NEAR(psnr(squared_error(*picture, raster)), 38.0, 0.7);
    }
}

TEST(Texture, IsExactWhenLossless)
{
    for (std::uint8_t channels = 1; channels <= 4; ++channels)
    {
        const Raster raster = sample_raster(301, 97, channels);
        const auto texture = encoded(raster, {.lossless = true});
        const auto picture = fed(texture).picture(301);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_EQ(*picture, raster);
        EXPECT_EQ(texture.chunks.back().squared_error, 0.0);
    }
}

TEST(Texture, IsExactWhereThatCostsLittle)
{
    const Raster raster = sample_raster(64, 48, 3);
    EXPECT_EQ(*fed(encoded(raster)).picture(64), raster);
    EXPECT_NE(
        *fed(encoded(
                 raster,
                 {.cheap_bits_per_pixel = 0.0, .small_bits_per_pixel = 0.0, .exact_bytes = 100}
             ))
             .picture(64),
        raster
    );
}

TEST(Texture, ShowsMoreWithEveryChunkAndSaysHowMuch)
{
    const Raster raster = sample_raster(600, 420, 3);
    const auto texture = encoded(raster, {.measure_every_chunk = true});
    ASSERT_GE(texture.chunks.size(), 6U);
    TextureDecoder decoder;
    double before = 65025.0;
    for (const TextureChunk& chunk : texture.chunks)
    {
        ASSERT_TRUE(decoder.feed(chunk.payload));
        const auto picture = decoder.picture(1024);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_DOUBLE_EQ(squared_error(*picture, raster), chunk.squared_error);
        EXPECT_LT(chunk.squared_error, before * 1.001);
        before = chunk.squared_error;
    }
    EXPECT_TRUE(decoder.complete());
}

TEST(Texture, SaysAboutHowMuchIsBetterWithinALayer)
{
    const Raster raster = sample_raster(600, 420, 3);
    const auto exact = encoded(raster, {.measure_every_chunk = true});
    const auto fast = encoded(raster);
    ASSERT_EQ(fast.chunks.size(), exact.chunks.size());
    for (std::size_t i = 0; i < fast.chunks.size(); ++i)
    {
        EXPECT_EQ(fast.chunks[i].payload, exact.chunks[i].payload);
        EXPECT_NEAR(psnr(fast.chunks[i].squared_error), psnr(exact.chunks[i].squared_error), 1.5);
    }
}

TEST(Texture, BeginsWithASmallPreview)
{
    const auto texture = encoded(sample_raster(700, 600, 3));
    EXPECT_GE(texture.chunks.front().payload.size(), 700U);
    EXPECT_LE(texture.chunks.front().payload.size(), 1500U);
    EXPECT_GE(psnr(texture.chunks.front().squared_error), 20.0);
}

TEST(Texture, CutsChunksOfUsefulLength)
{
    const auto texture = encoded(sample_raster(700, 600, 4), {.lossless = true});
    for (const TextureChunk& chunk : texture.chunks)
    {
        EXPECT_GE(chunk.payload.size(), 400U);
        EXPECT_LE(chunk.payload.size(), proto::kTargetChunkBytes - proto::kChunkChecksumBytes);
        EXPECT_EQ(chunk.tag, texture_tag(0, chunk.group));
    }
}

TEST(Texture, CodesTinyImages)
{
    for (const std::uint32_t width : {1U, 2U, 5U, 40U})
    {
        const Raster raster = sample_raster(width, 1, 3);
        const auto texture = encoded(raster, {.lossless = true});
        EXPECT_EQ(texture.chunks.size(), 1U);
        const auto picture = fed(texture).picture(64);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_EQ(*picture, raster);
    }
}

TEST(Texture, ScalesLargeImagesDown)
{
    const Raster raster = sample_raster(400, 300, 3);
    const auto texture = encoded(raster, {.max_size = 128, .lossless = true});
    EXPECT_EQ(texture.info.width, 128U);
    EXPECT_EQ(texture.info.height, 96U);
    const auto picture = fed(texture).picture(128);
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(*picture, downsampled(raster, 128));
}

TEST(Texture, MixesNoChannelsOfNormalMaps)
{
    Raster raster = sample_raster(64, 64, 3);
    for (std::size_t i = 2; i < raster.pixels.size(); i += 3)
    {
        raster.pixels[i] = 255;
    }
    const auto texture = encoded(
        raster,
        {.psnr = 35.0,
         .cheap_bits_per_pixel = 0.0,
         .small_bits_per_pixel = 0.0,
         .exact_bytes = 0,
         .is_normal_map = true}
    );
    const auto decoder = fed(texture);
    EXPECT_FALSE(decoder.header()->color_transform);
    const auto picture = decoder.picture(64);
    ASSERT_TRUE(picture) << picture.error().message;
    for (std::size_t i = 2; i < raster.pixels.size(); i += 3)
    {
        ASSERT_GE(picture->pixels[i], 254);
    }
}

TEST(Texture, GivesTheSameBytesAgain)
{
    const Raster raster = sample_raster(260, 260, 4);
    const auto first = encoded(raster);
    const auto second = encoded(raster);
    ASSERT_EQ(first.chunks.size(), second.chunks.size());
    for (std::size_t i = 0; i < first.chunks.size(); ++i)
    {
        EXPECT_EQ(first.chunks[i].payload, second.chunks[i].payload);
    }
}

TEST(TextureDecoder, ShowsSmallSizesWithoutTheFineChunks)
{
    const Raster raster = sample_raster(1024, 700, 3);
    const auto texture = encoded(raster, {.image = 5});
    const auto complete = fed(texture).picture(256);
    TextureDecoder decoder;
    std::size_t skipped = 0;
    for (const TextureChunk& chunk : texture.chunks)
    {
        if (texture_chunk_wanted(chunk.tag, 256))
        {
            ASSERT_TRUE(decoder.feed(chunk.payload));
        }
        else
        {
            ++skipped;
        }
    }
    EXPECT_GE(skipped, 3U);
    const auto small = decoder.picture(256);
    ASSERT_TRUE(small) << small.error().message;
    EXPECT_EQ(small->width, 256U);
    EXPECT_EQ(small->height, 175U);
    EXPECT_EQ(*small, *complete);
    EXPECT_LT(squared_error(*small, downsampled(raster, 256)), 40.0);
    // At full size it is a blurred image, not a broken one.
    const auto large = decoder.picture(1024);
    ASSERT_TRUE(large) << large.error().message;
    EXPECT_GT(psnr(squared_error(*large, raster)), 25.0);
}

TEST(TextureDecoder, SurvivesAnyGap)
{
    const Raster raster = sample_raster(600, 600, 3);
    const auto texture = encoded(raster);
    const double preview = texture.chunks.front().squared_error;
    for (std::size_t gap = 1; gap < texture.chunks.size(); ++gap)
    {
        TextureDecoder decoder;
        for (std::size_t i = 0; i < texture.chunks.size(); ++i)
        {
            if (i != gap)
            {
                ASSERT_TRUE(decoder.feed(texture.chunks[i].payload));
            }
        }
        EXPECT_FALSE(decoder.complete());
        const auto picture = decoder.picture(600);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_LE(squared_error(*picture, raster), preview * 1.001) << gap;
    }
}

TEST(TextureDecoder, KeepsNothingThatItNeverShows)
{
    const auto texture = encoded(sample_raster(600, 600, 3), {.cheap_bits_per_pixel = 1.0});
    TextureDecoder all;
    TextureDecoder small({.max_size = 256});
    for (const TextureChunk& chunk : texture.chunks)
    {
        ASSERT_TRUE(all.feed(chunk.payload));
        ASSERT_TRUE(small.feed(chunk.payload));
    }
    EXPECT_LT(small.coded_bytes(), all.coded_bytes() / 2);
    EXPECT_TRUE(small.complete());
    EXPECT_EQ(*small.picture(4096), *all.picture(256));
}

TEST(TextureDecoder, HalvesUntilThePictureFits)
{
    const auto decoder = fed(encoded(sample_raster(333, 100, 3)));
    const std::map<std::uint32_t, std::uint32_t> widths{
        {4096, 333}, {333, 333}, {332, 167}, {100, 84}, {50, 42}, {42, 42}};
    for (const auto& [max_size, width] : widths)
    {
        const auto picture = decoder.picture(max_size);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_EQ(picture->width, width);
    }
    const auto tiny = decoder.picture(1);
    ASSERT_TRUE(tiny) << tiny.error().message;
    EXPECT_EQ(tiny->width, 1U);
}

TEST(TextureDecoder, ReadsGoldenChunks)
{
    // Chunks, each after its length in two bytes.
    const auto file = read_file(VSPLIT_SOURCE_DIR "/tests/golden/texture/rgba_lossless.chunks");
    ASSERT_TRUE(file) << file.error().message;
    ByteReader reader(*file);
    TextureDecoder decoder;
    while (const auto length = reader.read<std::uint16_t>())
    {
        ASSERT_TRUE(decoder.feed(*reader.read_bytes(*length)));
    }
    const auto picture = decoder.picture(64);
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(*picture, sample_raster(24, 30, 4));
}

TEST(TextureTag, SaysWhatAChunkIsFor)
{
    static_assert(parse_texture_tag(texture_tag(3, 0)) == TextureTag{3, 256});
    static_assert(parse_texture_tag(texture_tag((1U << 19U) - 1, 7)).side == 32768);
    EXPECT_TRUE(texture_chunk_wanted(texture_tag(1, 0), 64));
    EXPECT_TRUE(texture_chunk_wanted(texture_tag(1, 2), 1024));
    EXPECT_FALSE(texture_chunk_wanted(texture_tag(1, 2), 1023));
}

}  // namespace
}  // namespace vsplit::image
