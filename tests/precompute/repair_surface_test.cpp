#include "precompute/repair_surface.h"

#include <gmock/gmock.h>

#include <limits>

namespace vsplit::precompute {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Two triangles of a square that turn against each other, a degenerate one, and one more of the same
/// square with vertices of its own.
Surface dirty_surface()
{
    Surface surface;
    surface.mesh.positions = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    surface.mesh.triangles = {{0, 1, 1}, {0, 1, 2}, {0, 3, 2}, {4, 5, 6}, {2, 1, 0}};
    SurfaceAttribute coordinates;
    coordinates.values = {9, 9, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1};
    coordinates.corners = {{0, 0, 0}, {1, 2, 3}, {4, 5, 3}, {1, 5, 2}, {0, 0, 0}};
    surface.attributes.push_back(coordinates);
    surface.groups = {5, 0, 1, 2, 5};
    return surface;
}

TEST(RepairSurface, TakesAttributesAndGroupsAlong)
{
    const auto repaired = repair_surface(dirty_surface());
    ASSERT_TRUE(repaired) << describe(repaired.error());
    EXPECT_EQ(repaired->repaired.report.degenerate_faces, 1U);
    EXPECT_EQ(repaired->repaired.report.duplicate_faces, 1U);
    EXPECT_EQ(repaired->repaired.report.flipped_faces, 1U);
    EXPECT_THAT(repaired->groups, ElementsAre(0, 1, 2));
    EXPECT_THAT(repaired->repaired.source_faces, ElementsAre(1, 2, 3));
    EXPECT_THAT(repaired->repaired.mesh.triangles[1], ElementsAre(0, 2, 3)) << "turned";
    const SurfaceAttribute& coordinates = repaired->attributes.at(0);
    EXPECT_THAT(
        coordinates.corners, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 1})
    );
    EXPECT_THAT(coordinates.values, ElementsAre(0, 0, 1, 0, 1, 1, 0, 1))
        << "merged, unused ones gone";
}

TEST(RepairSurface, ReplacesWhatIsNotFinite)
{
    Surface surface = dirty_surface();
    surface.attributes[0].values[2] = std::numeric_limits<float>::quiet_NaN();
    const auto repaired = repair_surface(surface);
    ASSERT_TRUE(repaired);
    EXPECT_EQ(repaired->attributes[0].values[0], 0.0F);
    EXPECT_THAT(repaired->dropped, SizeIs(1));
}

TEST(RepairSurface, RefusesAttributesThatDoNotFit)
{
    Surface surface = dirty_surface();
    surface.attributes[0].corners[1][0] = 6;
    EXPECT_EQ(repair_surface(surface).error().code, ErrorCode::BadIndex);
    surface = dirty_surface();
    surface.attributes[0].corners.pop_back();
    EXPECT_EQ(repair_surface(surface).error().code, ErrorCode::BadIndex);
    surface = dirty_surface();
    surface.groups.pop_back();
    EXPECT_EQ(repair_surface(surface).error().code, ErrorCode::BadIndex);
}

TEST(RepairSurface, KeepsZeroesOfBothSignsApart)
{
    Surface surface = dirty_surface();
    surface.attributes[0].values[2] = -0.0F;
    const auto repaired = repair_surface(surface);
    ASSERT_TRUE(repaired);
    EXPECT_EQ(repaired->attributes[0].size(), 5U);
}

}  // namespace
}  // namespace vsplit::precompute
