#include "surface_renderer.h"

#include "gl_context.h"
#include "image.h"
#include "painted_cube.h"
#include "surface_picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace vsplit::client {
namespace {

using Position = std::array<float, 3>;
using Color = std::array<int, 3>;

constexpr std::uint32_t kWidth = 200;
constexpr std::uint32_t kHeight = 200;

View cube_view()
{
    return Turntable({-1, -1, -1}, {1, 1, 1}, 1.0).view(-0.7);
}

// The colour of a point of the cube's surface in a picture from cube_view().
Color pixel_at(const Image& image, const Position& p)
{
    const View view = cube_view();
    Position eye{};
    for (std::size_t row = 0; row < 3; ++row)
    {
        eye[row] = view.to_eye[12 + row];
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            eye[row] += view.to_eye[4 * axis + row] * p[axis];
        }
    }
    const float x = view.to_clip[0] * eye[0] / -eye[2];
    const float y = view.to_clip[5] * eye[1] / -eye[2];
    const auto column = static_cast<std::size_t>((0.5F + 0.5F * x) * kWidth);
    const auto row = static_cast<std::size_t>((0.5F - 0.5F * y) * kHeight);
    const std::size_t at = 3 * (row * kWidth + column);
    return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

// Which of red, green, blue stands out; 3 when none does.
int hue(const Color& color)
{
    for (std::size_t k = 0; k < 3; ++k)
    {
        const int other = std::max(color[(k + 1) % 3], color[(k + 2) % 3]);
        if (color[k] > other + 60)
        {
            return static_cast<int>(k);
        }
    }
    return 3;
}

int brightness(const Color& color)
{
    return color[0] + color[1] + color[2];
}

// Where the middles of the four fields lie on a side: upper left and right, lower left and right.
// The front of the picture is the side of +z, see FrontOf.
constexpr std::array<Position, 4> kFields{
    {{-0.5F, 0.5F, 1}, {0.5F, 0.5F, 1}, {-0.5F, -0.5F, 1}, {0.5F, -0.5F, 1}}};

class SurfaceRendererTest : public testing::Test
{
protected:
    void SetUp() override
    {
        if (const auto context = GlContext::create(); !context)
        {
            GTEST_SKIP() << describe(context.error());
        }
    }

    // For looking at: pictures go to $VSPLIT_PICTURES, if that is set.
    static Image draw(
        const Surface& surface, const Appearance* appearance, const std::vector<Raster>& images = {}
    )
    {
        const auto image = surface_picture(
            make_surface_arrays(surface, appearance),
            appearance,
            images,
            cube_view(),
            {kWidth, kHeight, false}
        );
        EXPECT_TRUE(image.has_value());
        if (const char* folder = std::getenv("VSPLIT_PICTURES"))
        {
            const auto* test = testing::UnitTest::GetInstance()->current_test_info();
            static int number = 0;
            const std::string name =
                std::string(test->name()) + "-" + std::to_string(number++) + ".png";
            EXPECT_TRUE(write_png(std::filesystem::path(folder) / name, *image).has_value());
        }
        return *image;
    }
};

TEST_F(SurfaceRendererTest, PutsTheTextureUprightOnASideWithSeamsAllAround)
{
    const Appearance appearance = cube_appearance();
    const Image image = draw(cube_surface(), &appearance, {four_fields(256)});
    EXPECT_EQ(hue(pixel_at(image, kFields[0])), 0);
    EXPECT_EQ(hue(pixel_at(image, kFields[1])), 1);
    EXPECT_EQ(hue(pixel_at(image, kFields[2])), 2);
    EXPECT_EQ(hue(pixel_at(image, kFields[3])), 3);
    EXPECT_GT(brightness(pixel_at(image, kFields[3])), 400);
    // Right up to the seam: no other side's coordinates bleed in.
    EXPECT_EQ(hue(pixel_at(image, {-0.96F, 0.96F, 1})), 0);
    EXPECT_EQ(hue(pixel_at(image, {0.96F, 0.96F, 1})), 1);
    // On top the upper edge of the image is the far one.
    EXPECT_EQ(hue(pixel_at(image, {-0.5F, 1, -0.5F})), 0);
    EXPECT_EQ(hue(pixel_at(image, {-0.5F, 1, 0.5F})), 2);
}

TEST_F(SurfaceRendererTest, ReplacesATextureAsItsImageGetsSharper)
{
    const Appearance appearance = cube_appearance();
    const SurfaceArrays arrays = make_surface_arrays(cube_surface(), &appearance);
    const auto renderer = Renderer::create({kWidth, kHeight, false});
    ASSERT_TRUE(renderer.has_value());
    SurfaceRenderer& surface = (*renderer)->surface();
    surface.set_appearance(appearance);
    ASSERT_TRUE((*renderer)->show(arrays).has_value());
    EXPECT_EQ(surface.texture_memory_bytes(), 0U);
    const auto before = (*renderer)->picture(cube_view());
    EXPECT_EQ(hue(pixel_at(*before, kFields[0])), 3) << "white until something of the image comes";
    for (const std::uint32_t side : {2U, 16U, 64U, 256U})
    {
        SCOPED_TRACE(side);
        ASSERT_TRUE(surface.replace_texture(0, four_fields(side)).has_value());
        EXPECT_EQ(surface.texture_memory_bytes(), texture_bytes(side, side));
        const auto image = (*renderer)->picture(cube_view());
        EXPECT_EQ(hue(pixel_at(*image, kFields[0])), 0);
        EXPECT_EQ(hue(pixel_at(*image, kFields[1])), 1);
        EXPECT_EQ(hue(pixel_at(*image, kFields[2])), 2);
    }
    EXPECT_TRUE(surface.replace_texture(5, four_fields(4)).has_value()) << "nobody's image";
    const auto huge = surface.replace_texture(0, Raster{1U << 20, 1, 3, {}});
    ASSERT_FALSE(huge.has_value());
    EXPECT_EQ(huge.error().code, ErrorCode::LimitExceeded);
    EXPECT_EQ(surface.texture_memory_bytes(), texture_bytes(256, 256));
}

TEST_F(SurfaceRendererTest, DrawsColorsOfCornersAndMultipliesThemIn)
{
    Surface cube = cube_surface();
    SurfaceAttribute colors;
    colors.kind = AttributeKind::Color;
    colors.components = 3;
    colors.values = {1, 0, 0, 0, 1, 0};
    for (std::size_t t = 0; t < 12; ++t)
    {
        const std::uint32_t value = t / 2 == 4 ? 0 : 1;  // The front is red, the rest green.
        colors.corners.push_back({value, value, value});
    }
    cube.attributes.push_back(colors);
    const Image plain = draw(cube, nullptr);
    EXPECT_EQ(hue(pixel_at(plain, {0, 0, 1})), 0);
    EXPECT_EQ(hue(pixel_at(plain, {0, 1, 0})), 1);
    const Appearance appearance = cube_appearance();
    const Image painted = draw(cube, &appearance, {four_fields(64)});
    EXPECT_EQ(hue(pixel_at(painted, kFields[0])), 0);
    EXPECT_LT(brightness(pixel_at(painted, kFields[1])), 40) << "green times red is black";
    EXPECT_EQ(hue(pixel_at(painted, kFields[3])), 0);
}

TEST_F(SurfaceRendererTest, GivesEveryGroupItsMaterial)
{
    Appearance appearance = cube_appearance();
    for (Material& material : appearance.materials)
    {
        material.base_color_texture = {};
        material.base_color = {0, 0, 1, 1};
    }
    appearance.materials[4].base_color = {1, 0, 0, 1};
    appearance.materials[2].base_color = {0, 1, 0, 1};
    const Image image = draw(cube_surface(), &appearance);
    EXPECT_EQ(hue(pixel_at(image, {0, 0, 1})), 0);
    EXPECT_EQ(hue(pixel_at(image, {0, 1, 0})), 1);
    EXPECT_EQ(hue(pixel_at(image, {1, 0, 0})), 2);
    appearance.materials[4].emissive = {0, 0, 1};
    EXPECT_EQ(pixel_at(draw(cube_surface(), &appearance), {0, 0, 1})[2], 255) << "it glows";
    appearance.materials[4].emissive_texture.image = 0;
    EXPECT_LT(pixel_at(draw(cube_surface(), &appearance), {0, 0, 1})[2], 60)
        << "not before its texture is there";
}

// An image whose left half is there and whose right half is not.
Raster half_clear(std::uint8_t alpha)
{
    Raster raster{64, 64, 4, {}};
    for (std::uint32_t i = 0; i < 64 * 64; ++i)
    {
        const std::array<std::uint8_t, 4> texel{255, 0, 0, i % 64 < 32 ? std::uint8_t{255} : alpha};
        raster.pixels.insert(raster.pixels.end(), texel.begin(), texel.end());
    }
    return raster;
}

TEST_F(SurfaceRendererTest, CutsOutWhatTheMaskLeavesAndBlendsWhatOneSeesThrough)
{
    Appearance appearance = cube_appearance();
    for (Material& material : appearance.materials)
    {
        material.base_color_texture = {};
        material.base_color = {0, 0, 1, 1};
    }
    Material& front = appearance.materials[4];
    front.base_color = {1, 1, 1, 1};
    front.base_color_texture.image = 0;
    front.alpha_mode = AlphaMode::Mask;
    const Image masked = draw(cube_surface(), &appearance, {half_clear(100)});
    EXPECT_EQ(hue(pixel_at(masked, {-0.5F, 0, 1})), 0);
    EXPECT_EQ(hue(pixel_at(masked, {0.5F, 0, 1})), 2) << "the inside of the blue back";
    front.alpha_mode = AlphaMode::Blend;
    const Image blended = draw(cube_surface(), &appearance, {half_clear(128)});
    EXPECT_EQ(hue(pixel_at(blended, {-0.5F, 0, 1})), 0);
    const Color mixed = pixel_at(blended, {0.5F, 0, 1});
    EXPECT_GT(mixed[0], 70);
    EXPECT_GT(mixed[2], 30);
    EXPECT_LT(mixed[1], 30);
}

TEST_F(SurfaceRendererTest, GoesOnBeyondTheBordersAsTheMaterialSays)
{
    Surface cube = cube_surface();
    for (float& value : cube.attributes[0].values)
    {
        value *= 2.0F;  // Every side shows the image twice across and down.
    }
    Appearance appearance = cube_appearance();
    const Position second_field{0.25F, 0.75F, 1};  // Column 2 of 4: the image's left again.
    const Image repeated = draw(cube, &appearance, {four_fields(64)});
    EXPECT_EQ(hue(pixel_at(repeated, second_field)), 0);
    appearance.materials[4].base_color_texture.wrap_u = TextureWrap::Mirror;
    const Image mirrored = draw(cube, &appearance, {four_fields(64)});
    EXPECT_EQ(hue(pixel_at(mirrored, second_field)), 1);
    appearance.materials[4].base_color_texture.wrap_u = TextureWrap::Clamp;
    const Image clamped = draw(cube, &appearance, {four_fields(64)});
    EXPECT_EQ(hue(pixel_at(clamped, second_field)), 1);
    EXPECT_EQ(hue(pixel_at(clamped, {0.75F, 0.75F, 1})), 1);
}

TEST_F(SurfaceRendererTest, ChoosesTheSetOfTextureCoordinates)
{
    Surface cube = cube_surface();
    SurfaceAttribute second = cube.attributes[0];
    second.set = 1;
    second.values = {1, 0, 0, 0, 1, 1, 0, 1};  // Left and right changed.
    cube.attributes.push_back(second);
    Appearance appearance = cube_appearance();
    EXPECT_EQ(hue(pixel_at(draw(cube, &appearance, {four_fields(64)}), kFields[0])), 0);
    appearance.materials[4].base_color_texture.tex_coord_set = 1;
    EXPECT_EQ(hue(pixel_at(draw(cube, &appearance, {four_fields(64)}), kFields[0])), 1);
}

TEST_F(SurfaceRendererTest, BendsTheLightByANormalMap)
{
    Appearance appearance = cube_appearance();
    for (Material& material : appearance.materials)
    {
        material.base_color_texture = {};
    }
    const Image flat = draw(cube_surface(), &appearance);
    appearance.materials[4].normal_texture.image = 0;
    Raster up{4, 4, 3, {}};
    Raster down{4, 4, 3, {}};
    for (int i = 0; i < 16; ++i)
    {
        for (const int channel : {128, 218, 218})  // Leaning up by 45 degrees, where the sky is.
        {
            up.pixels.push_back(static_cast<std::uint8_t>(channel));
        }
        for (const int channel : {128, 38, 218})
        {
            down.pixels.push_back(static_cast<std::uint8_t>(channel));
        }
    }
    const Image bright = draw(cube_surface(), &appearance, {up});
    const Image dark = draw(cube_surface(), &appearance, {down});
    const Position front{0.1F, 0.1F, 1};
    EXPECT_GT(brightness(pixel_at(bright, front)), brightness(pixel_at(dark, front)) + 60);
    EXPECT_LT(brightness(pixel_at(dark, front)), brightness(pixel_at(flat, front)));
}

TEST_F(SurfaceRendererTest, DrawsTheGridOverASurface)
{
    const Appearance appearance = cube_appearance();
    const SurfaceArrays arrays = make_surface_arrays(cube_surface(), &appearance);
    const auto plain =
        surface_picture(arrays, &appearance, {}, cube_view(), {kWidth, kHeight, false});
    const auto lines =
        surface_picture(arrays, &appearance, {}, cube_view(), {kWidth, kHeight, true});
    ASSERT_TRUE(plain.has_value() && lines.has_value());
    EXPECT_NE(plain->pixels, lines->pixels);
}

TEST(ToRgba, FillsTheChannelsThatAnImageHasNot)
{
    using Bytes = std::vector<std::uint8_t>;
    EXPECT_EQ(to_rgba({1, 1, 1, {9}}), (Bytes{9, 9, 9, 255}));
    EXPECT_EQ(to_rgba({1, 1, 2, {9, 7}}), (Bytes{9, 9, 9, 7}));
    EXPECT_EQ(to_rgba({1, 1, 3, {1, 2, 3}}), (Bytes{1, 2, 3, 255}));
    EXPECT_EQ(to_rgba({1, 1, 4, {1, 2, 3, 4}}), (Bytes{1, 2, 3, 4}));
}

}  // namespace
}  // namespace vsplit::client
