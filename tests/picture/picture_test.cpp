#include "picture/picture.h"

#include "codec/shapes.h"
#include "core/crc32c.h"
#include "picture/picture_samples.h"
#include "picture/projected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace vsplit::test {
namespace {

using picture::draw;
using picture::Picture;
using picture::Projection;
using picture::Scene;
using picture::Texture;
using picture::View;

/// Looks along -z at the square of textured_square(), which fills the picture.
View front_view()
{
    View view;
    view.projection = Projection::Orthographic;
    view.eye = {0.0, 0.0, 4.0};
    view.zoom = 0.5;
    return view;
}

Raster checkers(std::uint32_t size, std::uint32_t cell)
{
    Raster image{size, size, 1, {}};
    for (std::uint32_t i = 0; i < size * size; ++i)
    {
        const bool white = (i % size / cell + i / size / cell) % 2 == 0;
        image.pixels.push_back(white ? 255 : 0);
    }
    return image;
}

Appearance with_texture()
{
    Appearance appearance;
    appearance.groups.push_back({"", 0});
    appearance.materials.emplace_back().base_color_texture.image = 0;
    appearance.images.emplace_back();
    return appearance;
}

TEST(Picture, GivesEveryPixelOfASheetToExactlyOneTriangle)
{
    Surface sheet = textured_square(23);
    std::minstd_rand random(7);
    for (auto& position : sheet.mesh.positions)
    {
        const bool inside = std::abs(position[0]) < 0.99 && std::abs(position[1]) < 0.99;
        position[0] += inside ? 0.02 * (static_cast<double>(random() % 1000) / 1000.0 - 0.5) : 0.0;
        position[1] += inside ? 0.02 * (static_cast<double>(random() % 1000) / 1000.0 - 0.5) : 0.0;
    }
    constexpr std::uint32_t kSize = 128;
    const auto vertices = picture::project(sheet.mesh.positions, front_view(), kSize);
    std::vector<int> visits(kSize * kSize, 0);
    for (const Triangle& triangle : sheet.mesh.triangles)
    {
        const auto screen =
            picture::ScreenTriangle::make(vertices, triangle, Projection::Orthographic);
        ASSERT_TRUE(screen);
        screen->visit_pixels(kSize, [&](std::int64_t x, std::int64_t y) {
            ++visits[static_cast<std::size_t>(y * kSize + x)];
        });
    }
    EXPECT_THAT(visits, ::testing::Each(1));
}

TEST(Picture, ShowsTheNearerOfTwoTriangles)
{
    Surface surface = textured_square(1);
    for (const double z : {1.0, -1.0})
    {
        for (std::size_t v = 0; v < 4; ++v)
        {
            auto position = surface.mesh.positions[v];
            position[2] = z;
            surface.mesh.positions.push_back(position);
        }
    }
    surface.mesh.triangles = {{0, 2, 1}, {4, 6, 5}, {8, 10, 9}};
    const Picture seen = draw({.surface = &surface}, front_view(), {.size = 16});
    EXPECT_EQ(seen.triangles.front(), 1U);
    EXPECT_FLOAT_EQ(seen.depths.front(), 3.0F);
    EXPECT_FALSE(seen.covered(seen.triangles.size() - 1));
}

TEST(Picture, PlacesTexturesByTheirUpperLeftCorner)
{
    const Surface square = textured_square(3);
    const Appearance appearance = with_texture();
    Raster image{2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
    const std::vector<Texture> textures{Texture(image)};
    const Picture seen = draw({&square, &appearance, textures}, front_view(), {.size = 64});
    const auto strongest = [&](std::size_t x, std::size_t y) {
        const std::uint8_t* const rgb = &seen.colors[3 * (y * 64 + x)];
        return std::max_element(rgb, rgb + 3) - rgb;
    };
    EXPECT_EQ(strongest(4, 4), 0);
    EXPECT_EQ(strongest(60, 4), 1);
    EXPECT_EQ(strongest(4, 60), 2);
}

TEST(Picture, KeepsTexturesStraightInPerspective)
{
    // Two triangles and many show the same when the coordinates are perspective-correct.
    Appearance appearance = with_texture();
    const std::vector<Texture> textures{Texture(checkers(64, 8))};
    View view;
    view.eye = {1.5, -2.0, 1.5};
    view.forward = picture::normalized({-1.5, 2.0, -1.5});
    view.right = picture::normalized(picture::cross(view.forward, {0.0, 1.0, 0.0}));
    view.up = picture::cross(view.right, view.forward);
    const Surface coarse = textured_square(1);
    const Surface fine = textured_square(16);
    const Picture a = draw({&coarse, &appearance, textures}, view, {.size = 128});
    const Picture b = draw({&fine, &appearance, textures}, view, {.size = 128});
    ASSERT_EQ(a.colors.size(), b.colors.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.colors.size(); ++i)
    {
        different += std::abs(a.colors[i] - b.colors[i]) > 12 ? 1 : 0;
    }
    EXPECT_LT(different, a.colors.size() / 200);
}

TEST(Picture, ShowsSmallPatternsAsTheirMean)
{
    const Surface square = textured_square(1);
    const Appearance appearance = with_texture();
    const std::vector<Texture> textures{Texture(checkers(1024, 1))};
    const Picture seen = draw({&square, &appearance, textures}, front_view(), {.size = 32});
    const auto [least, most] = std::ranges::minmax(seen.colors);
    EXPECT_LE(most - least, 1);
}

TEST(Picture, LeavesOutWhatTheMaskLeavesOut)
{
    const Surface square = textured_square(1);
    Appearance appearance = with_texture();
    appearance.materials[0].alpha_mode = AlphaMode::Mask;
    Raster image{2, 1, 2, {255, 255, 255, 0}};
    const std::vector<Texture> textures{Texture(image)};
    const Picture seen = draw({&square, &appearance, textures}, front_view(), {.size = 64});
    EXPECT_TRUE(seen.covered(32 * 64 + 10));
    EXPECT_FALSE(seen.covered(32 * 64 + 54));
}

TEST(Picture, BlendsColorsBetweenVertices)
{
    Surface square = textured_square(1);
    SurfaceAttribute colors;
    colors.kind = AttributeKind::Color;
    colors.components = 3;
    colors.values = {1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0};
    colors.corners = square.mesh.triangles;
    square.attributes.push_back(colors);
    const Picture seen = draw({.surface = &square}, front_view(), {.size = 64});
    const std::uint8_t* const middle = &seen.colors[3 * (32 * 64 + 32)];
    EXPECT_NEAR(middle[0], middle[1], 6);
    EXPECT_EQ(middle[2], 0);
    EXPECT_GT(seen.colors[3 * 32 * 64], 3 * seen.colors[3 * 32 * 64 + 1]);
}

TEST(Picture, IsTheSameOnEveryMachine)
{
    Surface ball{sphere(12, 20, 0.05, 3), {}, {}};
    const auto views = picture::corner_views(ball.mesh.positions);
    ASSERT_EQ(views.size(), picture::kCornerViews);
    std::uint32_t sum = 0;
    for (const View& view : views)
    {
        const Picture seen = draw({.surface = &ball}, view, {.size = 96});
        sum = 31 * sum + crc32c(std::as_bytes(std::span(seen.colors)));
        sum = 31 * sum + crc32c(std::as_bytes(std::span(seen.triangles)));
    }
    EXPECT_EQ(sum, 269792104U);
}

TEST(Picture, HoldsTheWholeModelInEveryView)
{
    Surface ball{sphere(12, 20, 0.3, 5), {}, {}};
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic})
    {
        for (const View& view : picture::corner_views(ball.mesh.positions, 8, projection))
        {
            const Picture seen = draw({.surface = &ball}, view, {.size = 64});
            std::size_t covered = 0;
            for (std::size_t i = 0; i < 64; ++i)
            {
                EXPECT_FALSE(seen.covered(i) || seen.covered(63 * 64 + i));
                EXPECT_FALSE(seen.covered(64 * i) || seen.covered(64 * i + 63));
                covered += seen.covered(32 * 64 + i) ? 1 : 0;
            }
            EXPECT_GT(covered, 32U);
        }
    }
}

}  // namespace
}  // namespace vsplit::test
