#include "precompute/image_header.h"

#include "image_files.h"

#include <gtest/gtest.h>

namespace vsplit::precompute {
namespace {

using test::bytes_of;

TEST(ImageHeader, ReadsPng)
{
    const std::string png = test::tiny_png();
    const auto header = read_image_header(bytes_of(png));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->format, ImageFormat::Png);
    EXPECT_EQ(header->width, 1U);
    EXPECT_EQ(header->height, 1U);
    EXPECT_EQ(header->channels, 3);
}

TEST(ImageHeader, CountsTheAlphaOfATransparentPalette)
{
    std::string png = test::tiny_png();
    png[25] = 3;
    png.insert(33, std::string("\0\0\0\1tRNS\0\0\0\0\0", 13));
    const auto header = read_image_header(bytes_of(png));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->channels, 4);
}

TEST(ImageHeader, ReadsProgressiveJpegBehindOtherSegments)
{
    const auto header = read_image_header(bytes_of(test::jpeg_start()));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->format, ImageFormat::Jpeg);
    EXPECT_EQ(header->width, 640U);
    EXPECT_EQ(header->height, 480U);
    EXPECT_EQ(header->channels, 3);
}

TEST(ImageHeader, RefusesCmykOtherFormatsAndSidesOfZero)
{
    EXPECT_FALSE(read_image_header(bytes_of(test::jpeg_start(4))));
    EXPECT_FALSE(read_image_header(bytes_of("RIFF\x10\0\0\0WEBPVP8 ")));
    std::string png = test::tiny_png();
    png[19] = 0;
    EXPECT_FALSE(read_image_header(bytes_of(png)));
    png[17] = 1;  // 65536
    EXPECT_FALSE(read_image_header(bytes_of(png)));
}

TEST(ImageHeader, RefusesEveryTruncationThatHidesTheSize)
{
    const std::string png = test::tiny_png();
    for (std::size_t size = 0; size < 33; ++size)
    {
        EXPECT_FALSE(read_image_header(bytes_of(png.substr(0, size)))) << size;
    }
    const std::string jpeg = test::jpeg_start();
    for (std::size_t size = 0; size < jpeg.size(); ++size)
    {
        EXPECT_FALSE(read_image_header(bytes_of(jpeg.substr(0, size)))) << size;
    }
}

}  // namespace
}  // namespace vsplit::precompute
