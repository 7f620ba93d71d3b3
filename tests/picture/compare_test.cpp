#include "picture/compare.h"

#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using picture::compare;
using picture::Picture;
using picture::Region;

/// A picture of one colour whose left half is covered.
Picture plain(std::uint8_t value)
{
    Picture result;
    result.size = 16;
    result.colors.assign(3 * 16 * 16, value);
    result.depths.assign(16 * 16, 1.0F);
    result.triangles.assign(16 * 16, Picture::kNoTriangle);
    for (std::size_t i = 0; i < result.triangles.size(); ++i)
    {
        if (i % 16 < 8)
        {
            result.triangles[i] = 0;
        }
    }
    return result;
}

TEST(Compare, SaysThatEqualPicturesAreEqual)
{
    const auto difference = compare(plain(90), plain(90), Region::All);
    EXPECT_EQ(difference.mse, 0.0);
    EXPECT_EQ(difference.psnr, picture::kSamePsnr);
    EXPECT_DOUBLE_EQ(difference.ssim, 1.0);
}

TEST(Compare, MeasuresTheMeanSquareOverTheRegion)
{
    const Picture a = plain(90);
    Picture b = a;
    for (std::size_t i = 0; i < 3 * 16; ++i)  // the first row, half of it covered
    {
        b.colors[i] = 100;
    }
    EXPECT_DOUBLE_EQ(compare(a, b, Region::All).mse, 100.0 / 16.0);
    EXPECT_DOUBLE_EQ(compare(a, b, Region::Silhouettes).mse, 100.0 / 16.0);
    b.triangles.assign(b.triangles.size(), Picture::kNoTriangle);
    b.colors[3 * 15] = 140;
    EXPECT_DOUBLE_EQ(compare(a, b, Region::Silhouettes).mse, 100.0 / 16.0)
        << "a pixel that neither covers";
}

TEST(Compare, SeesLostStructureWhereTheMeanIsTheSame)
{
    Picture a = plain(100);
    Picture b = plain(100);
    for (std::size_t i = 0; i < a.colors.size(); ++i)
    {
        a.colors[i] = static_cast<std::uint8_t>(100 + 40 * (i / 3 % 2));
        b.colors[i] = 120;
    }
    EXPECT_LT(compare(a, b, Region::All).ssim, 0.2);
}

TEST(Compare, GivesTheDecibelsOfAMeanSquare)
{
    EXPECT_NEAR(picture::psnr_of(65.025), 30.0, 1e-9);
    EXPECT_EQ(picture::psnr_of(0.0), picture::kSamePsnr);
}

}  // namespace
}  // namespace vsplit::test
