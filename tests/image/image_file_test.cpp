#include "image/image_file.h"

#include "image/downsample.h"
#include "image/sample_raster.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace vsplit::image {
namespace {

using test::sample_raster;
using test::squared_error;

std::vector<std::byte> png_of(const png_image& form, const void* pixels, const void* colors)
{
    png_image image = form;
    image.version = PNG_IMAGE_VERSION;
    png_alloc_size_t length = PNG_IMAGE_PNG_SIZE_MAX(image) + 4096;
    std::vector<std::byte> bytes(length);
    EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &length, 0, pixels, 0, colors), 0);
    bytes.resize(length);
    return bytes;
}

TEST(ImageFile, ReadsThePngThatItWrote)
{
    for (std::uint8_t channels = 1; channels <= 4; ++channels)
    {
        const Raster raster = sample_raster(33, 17, channels);
        const auto bytes = write_png(raster);
        ASSERT_TRUE(bytes) << bytes.error().message;
        const auto info = probe_image(*bytes);
        ASSERT_TRUE(info) << info.error().message;
        EXPECT_EQ(info->width, 33U);
        EXPECT_EQ(info->height, 17U);
        EXPECT_EQ(info->channels, channels);
        const auto read = read_image(*bytes);
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(*read, raster);
    }
}

TEST(ImageFile, ExpandsPalettes)
{
    png_image form{};
    form.width = 2;
    form.height = 1;
    form.format = PNG_FORMAT_RGB_COLORMAP;
    form.colormap_entries = 2;
    const std::array<std::uint8_t, 6> colors{255, 0, 0, 0, 0, 200};
    const std::array<std::uint8_t, 2> pixels{1, 0};
    const auto read = read_image(png_of(form, pixels.data(), colors.data()));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->channels, 3);
    EXPECT_EQ(read->pixels, (std::vector<std::uint8_t>{0, 0, 200, 255, 0, 0}));
}

TEST(ImageFile, LeavesTransparentPaletteColoursUnmultiplied)
{
    png_image form{};
    form.width = 2;
    form.height = 1;
    form.format = PNG_FORMAT_RGBA_COLORMAP;
    form.colormap_entries = 2;
    const std::array<std::uint8_t, 8> colors{255, 90, 0, 100, 0, 0, 200, 255};
    const std::array<std::uint8_t, 2> pixels{0, 1};
    const auto read = read_image(png_of(form, pixels.data(), colors.data()));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->channels, 4);
    EXPECT_EQ(read->pixels, (std::vector<std::uint8_t>{255, 90, 0, 100, 0, 0, 200, 255}));
}

TEST(ImageFile, ReducesSixteenBitsToEight)
{
    png_image form{};
    form.width = 2;
    form.height = 1;
    form.format = PNG_FORMAT_LINEAR_Y;
    const std::array<std::uint16_t, 2> pixels{0x8000, 0xFFFF};
    const auto read = read_image(png_of(form, pixels.data(), nullptr));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->channels, 1);
    EXPECT_EQ(read->pixels, (std::vector<std::uint8_t>{128, 255}));
}

TEST(ImageFile, ReadsBaselineAndProgressiveJpeg)
{
    for (const std::uint8_t channels : {std::uint8_t{1}, std::uint8_t{3}})
    {
        for (const bool progressive : {false, true})
        {
            const Raster raster = sample_raster(61, 40, channels);
            const auto bytes = write_jpeg(raster, {.quality = 95, .progressive = progressive});
            ASSERT_TRUE(bytes) << bytes.error().message;
            const auto read = read_image(*bytes);
            ASSERT_TRUE(read) << read.error().message;
            EXPECT_EQ(read->channels, channels);
            EXPECT_LT(squared_error(*read, raster), 20.0);
        }
    }
}

TEST(ImageFile, LeavesAlphaOutOfJpeg)
{
    const auto bytes = write_jpeg(sample_raster(20, 20, 4));
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto info = probe_image(*bytes);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->channels, 3);
}

TEST(ImageFile, RefusesOtherFiles)
{
    constexpr std::string_view kText = "GIF89a and so on";
    const auto text = std::as_bytes(std::span(kText));
    EXPECT_EQ(read_image(text).error().code, ErrorCode::UnsupportedInput);
    EXPECT_EQ(probe_image({}).error().code, ErrorCode::UnsupportedInput);
}

TEST(ImageFile, ChecksTheSizeBeforeItDecodes)
{
    const auto png = write_png(sample_raster(50, 20, 3));
    const auto jpeg = write_jpeg(sample_raster(50, 20, 3));
    for (const auto& file : {*png, *jpeg})
    {
        EXPECT_TRUE(read_image(file, {.max_side = 50, .max_pixels = 1000}));
        const auto side = read_image(file, {.max_side = 49});
        EXPECT_EQ(side.error().code, ErrorCode::InputTooLarge);
        const auto pixels = probe_image(file, {.max_pixels = 999});
        EXPECT_EQ(pixels.error().code, ErrorCode::InputTooLarge);
    }
}

TEST(ImageFile, RejectsEveryTruncation)
{
    const auto png = write_png(sample_raster(9, 7, 3));
    const auto jpeg = write_jpeg(sample_raster(9, 7, 3));
    for (const auto& file : {*png, *jpeg})
    {
        for (std::size_t length = 0; length < file.size(); ++length)
        {
            // The last bytes of both say nothing but that the file ends.
            const bool tail = length + 12 >= file.size();
            EXPECT_TRUE(tail || !read_image(std::span(file).first(length))) << length;
        }
    }
}

TEST(Downsample, GivesTheMeanOfTheAreaUnderAPixel)
{
    const Raster raster{.width = 3, .height = 2, .channels = 1, .pixels = {0, 90, 30, 60, 30, 90}};
    const Raster half = downsampled(raster, 2);
    EXPECT_EQ(half.width, 2U);
    EXPECT_EQ(half.height, 1U);
    // Columns cover one and a half pixels: (0 + 60 + (90 + 30) / 2) / 3 and (30 + 90 + 60) / 3.
    EXPECT_EQ(half.pixels, (std::vector<std::uint8_t>{40, 60}));
    EXPECT_EQ(downsampled(raster, 3), raster);
}

TEST(Downsample, KeepsFlatImagesFlat)
{
    const Raster raster{
        .width = 37,
        .height = 11,
        .channels = 2,
        .pixels = std::vector<std::uint8_t>(37 * 11 * 2, 201)};
    const Raster small = downsampled(raster, 8);
    EXPECT_EQ(small.width, 8U);
    EXPECT_EQ(small.height, 2U);
    EXPECT_TRUE(std::all_of(small.pixels.begin(), small.pixels.end(), [](std::uint8_t value) {
        return value == 201;
    }));
}

}  // namespace
}  // namespace vsplit::image
