#include "picture/cracks.h"

#include "codec/shapes.h"
#include "picture/picture_samples.h"

#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using picture::CrackCount;
using picture::CrackDetector;

constexpr std::uint32_t kSize = 256;

/// A detector for an original.
CrackDetector detector_of(const Surface& original)
{
    return {original, picture::corner_views(original.mesh.positions), kSize};
}

/// The largest distance between spheres of radius 1 and of so few rings or sectors, generously.
double sphere_error(std::uint32_t rings)
{
    return 1.0 - std::cos(3.2 / rings);
}

TEST(CrackDetector, IsSilentOnTheOriginal)
{
    const Surface ball = cut_sphere(64, 128, 0.0);
    const CrackCount count = detector_of(ball).count(ball, 0.0);
    EXPECT_EQ(count.cracked(), 0U);
    EXPECT_GT(count.judged, 8 * 25000U);
}

TEST(CrackDetector, FindsACrackNarrowerThanAPixel)
{
    const CrackDetector detector = detector_of(cut_sphere(64, 128, 0.0));
    // A sphere of 2 fills 95 % of 256 pixels: a pixel is 0.0082 wide.
    for (const double gap : {0.016, 0.008, 0.002})
    {
        const CrackCount count = detector.count(cut_sphere(64, 128, gap), gap);
        EXPECT_GT(count.cracked(), 3U) << gap;
    }
}

TEST(CrackDetector, FindsACrackAtACoarseLevel)
{
    const CrackDetector detector = detector_of(cut_sphere(64, 128, 0.0));
    const double error = sphere_error(8);
    EXPECT_EQ(detector.count(cut_sphere(8, 16, 0.0), error).cracked(), 0U);
    EXPECT_GT(detector.count(cut_sphere(8, 16, 0.004), error + 0.004).cracked(), 3U);
}

TEST(CrackDetector, FindsWhatShowsTheBackgroundThroughASheet)
{
    Surface sheet = textured_square(40);
    const CrackDetector detector = detector_of(sheet);
    sheet.mesh.triangles.erase(sheet.mesh.triangles.begin() + 2 * 40 * 20 + 40);
    const CrackCount count = detector.count(sheet, 0.0);
    EXPECT_GT(count.background, 0U);
    EXPECT_EQ(count.see_through, 0U);
}

TEST(CrackDetector, IsSilentOnCoarseLevels)
{
    const CrackDetector detector = detector_of(cut_sphere(64, 128, 0.0));
    for (const std::uint32_t rings : {32U, 16U, 8U, 4U})
    {
        const CrackCount count =
            detector.count(cut_sphere(rings, 2 * rings, 0.0), sphere_error(rings));
        EXPECT_EQ(count.cracked(), 0U) << rings;
    }
}

TEST(CrackDetector, IsSilentWhereAHoleMovesOrCloses)
{
    const CrackDetector detector = detector_of(cut_sphere(64, 128, 0.0, 0.8));
    for (const double hole : {0.75, 0.85, 1.0, 2.0})
    {
        const double moved = std::min(std::abs(hole - 0.8), 0.4) + 0.05;
        const CrackCount count = detector.count(cut_sphere(64, 128, 0.0, hole), moved);
        EXPECT_EQ(count.cracked(), 0U) << hole;
    }
}

TEST(CrackDetector, IsSilentWhereOnePartMovesBeforeAnother)
{
    const Surface balls{joined(sphere(24, 40, 0.0, 1), sphere(24, 40, 0.0, 1), 1.7), {}, {}};
    const CrackDetector detector = detector_of(balls);
    for (const double shift : {1.66, 1.74, 1.8, 1.95})
    {
        const Surface moved{joined(sphere(24, 40, 0.0, 1), sphere(24, 40, 0.0, 1), shift), {}, {}};
        EXPECT_EQ(detector.count(moved, std::abs(shift - 1.7)).cracked(), 0U) << shift;
    }
}

}  // namespace
}  // namespace vsplit::test
