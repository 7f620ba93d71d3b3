#include "precompute/tex_coord_bits.h"

#include <gtest/gtest.h>

namespace vsplit::test {
namespace {

using precompute::choose_tex_coord_bits;

/// The bits for texture coordinates from 0 to `extent` on an image of so many pixels a side.
int bits_for(float extent, std::uint32_t side, std::uint32_t max_size = 2048)
{
    SurfaceAttribute attribute;
    attribute.values = {0.0F, 0.0F, extent, extent / 2.0F};
    Appearance appearance;
    appearance.images.push_back({"", side, side / 2, 3});
    appearance.materials.emplace_back().base_color_texture.image = 0;
    return choose_tex_coord_bits(std::vector{attribute}, appearance, max_size);
}

TEST(ChooseTexCoordBits, GivesLargeImagesMore)
{
    EXPECT_EQ(bits_for(1.0F, 256), 12);
    EXPECT_EQ(bits_for(1.0F, 2048), 13);
    EXPECT_EQ(bits_for(1.0F, 4096, 4096), 14);
    EXPECT_EQ(bits_for(1.0F, 32768, 32768), 14);
}

TEST(ChooseTexCoordBits, GivesImagesThatRepeatMore)
{
    EXPECT_EQ(bits_for(8.0F, 512), 14);
}

TEST(ChooseTexCoordBits, CountsWhatIsLeftOfScaledImages)
{
    EXPECT_EQ(bits_for(1.0F, 4096, 1024), 12);
}

TEST(ChooseTexCoordBits, GivesFewWithoutImages)
{
    SurfaceAttribute attribute;
    attribute.values = {0.0F, 0.0F, 9.0F, 9.0F};
    EXPECT_EQ(choose_tex_coord_bits(std::vector{attribute}, {}, 2048), 10);
    EXPECT_EQ(choose_tex_coord_bits({}, {}, 2048), 10);
}

}  // namespace
}  // namespace vsplit::test
