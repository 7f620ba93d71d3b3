#include "picture/decoded_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using ::testing::ElementsAre;

TEST(DecodedSurface, HasAValueForEveryWedge)
{
    codec::AttributeInfo coordinates;
    coordinates.set = 1;
    coordinates.origin = {-1.0F, 2.0F, 0.0F, 0.0F};
    coordinates.cell = 0.5F;
    codec::AttributeInfo normals;
    normals.kind = AttributeKind::Normal;
    normals.components = 3;
    normals.bits = 8;
    codec::LevelAttributes level;
    level.wedge_vertices = {0, 1, 2, 2};
    level.wedges = {{0, 1, 2}, {1, 0, 3}};
    level.values = {{0, 0, 2, 4, 1, 1, 6, 8}, {}};  // normals come later
    const std::vector<codec::AttributeInfo> infos{coordinates, normals};
    const auto decoded = picture::decoded_attributes(infos, level);
    ASSERT_EQ(decoded.size(), 1U);
    EXPECT_EQ(decoded[0].kind, AttributeKind::TexCoord);
    EXPECT_EQ(decoded[0].set, 1);
    EXPECT_EQ(decoded[0].corners, level.wedges);
    EXPECT_THAT(decoded[0].values, ElementsAre(-1.0F, 2.0F, 0.0F, 4.0F, -0.5F, 2.5F, 2.0F, 6.0F));
    level.values[1] = {127, 127, 127, 127, 127, 127, 127, 127};
    const auto complete = picture::decoded_attributes(infos, level);
    ASSERT_EQ(complete.size(), 2U);
    EXPECT_EQ(complete[1].kind, AttributeKind::Normal);
    EXPECT_EQ(complete[1].values.size(), 12U);
    EXPECT_FLOAT_EQ(complete[1].values[2], 1.0F);
}

}  // namespace
}  // namespace vsplit::test
