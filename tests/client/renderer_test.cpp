#include "renderer.h"

#include "gl_context.h"
#include "image.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

namespace vsplit::client {
namespace {

constexpr std::uint32_t kWidth = 120;
constexpr std::uint32_t kHeight = 160;

// A cube of edge 2 around the origin, outward triangles; `faces`: how many of the twelve.
codec::Step cube_step(std::uint32_t faces, std::vector<codec::TriangleUpdate>& storage)
{
    const std::vector<Triangle> cube{
        {0, 2, 1},
        {1, 2, 3},
        {4, 5, 6},
        {5, 7, 6},
        {0, 1, 4},
        {1, 5, 4},
        {2, 6, 3},
        {3, 6, 7},
        {0, 4, 2},
        {2, 4, 6},
        {1, 3, 5},
        {3, 7, 5}};
    storage.clear();
    for (std::uint32_t slot = 0; slot < faces; ++slot)
    {
        storage.push_back({slot, cube[slot]});
    }
    codec::Step step;
    step.kind = codec::StepKind::Chunk;
    step.vertices = 8;
    step.faces = faces;
    step.triangles = storage;
    return step;
}

void cube_positions(std::uint32_t first, std::uint32_t count, std::span<float> out)
{
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const std::uint32_t corner = first + i;
        out[3 * i] = corner & 1U ? 1.0F : -1.0F;
        out[3 * i + 1] = corner & 2U ? 1.0F : -1.0F;
        out[3 * i + 2] = corner & 4U ? 1.0F : -1.0F;
    }
}

View cube_view()
{
    return Turntable({-1, -1, -1}, {1, 1, 1}, static_cast<double>(kWidth) / kHeight).view(0.5);
}

std::array<int, 3> pixel(const Image& image, std::uint32_t x, std::uint32_t y)
{
    const std::size_t at = 3 * (std::size_t{y} * image.width + x);
    return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

// The colour of a point of the cube's surface in a picture from cube_view().
std::array<int, 3> pixel_at(const Image& image, const std::array<float, 3>& p)
{
    const View view = cube_view();
    std::array<float, 3> eye{};
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
    return pixel(
        image,
        static_cast<std::uint32_t>((0.5F + 0.5F * x) * kWidth),
        static_cast<std::uint32_t>((0.5F - 0.5F * y) * kHeight)
    );
}

int difference(const std::array<int, 3>& a, const std::array<int, 3>& b)
{
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

std::size_t different_pixels(const Image& a, const Image& b)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 3)
    {
        count += a.pixels[i] != b.pixels[i] || a.pixels[i + 1] != b.pixels[i + 1] ||
                         a.pixels[i + 2] != b.pixels[i + 2]
                     ? 1
                     : 0;
    }
    return count;
}

class RendererTest : public testing::Test
{
protected:
    void SetUp() override
    {
        if (const auto context = GlContext::create(); !context)
        {
            GTEST_SKIP() << describe(context.error());
        }
    }

    static std::unique_ptr<Renderer> make_renderer(bool wireframe = false)
    {
        auto renderer = Renderer::create({kWidth, kHeight, wireframe});
        EXPECT_TRUE(renderer.has_value()) << describe(renderer.error());
        EXPECT_TRUE((*renderer)->reserve(8, 12).has_value());
        return std::move(*renderer);
    }

    static Image picture_of_cube(Renderer& renderer, std::uint32_t faces)
    {
        std::vector<codec::TriangleUpdate> storage;
        GpuBuffers buffers(3.5);
        buffers.apply(cube_step(faces, storage), cube_positions);
        renderer.upload(buffers);
        auto image = renderer.picture(cube_view());
        EXPECT_TRUE(image.has_value());
        return *image;
    }
};

TEST_F(RendererTest, DrawsTheModelBeforeTheBackground)
{
    const auto renderer = make_renderer();
    const Image empty = picture_of_cube(*renderer, 0);
    const Image cube = picture_of_cube(*renderer, 12);
    ASSERT_EQ(cube.width, kWidth);
    ASSERT_EQ(cube.height, kHeight);
    EXPECT_GT(
        difference(pixel(cube, kWidth / 2, kHeight / 2), pixel(empty, kWidth / 2, kHeight / 2)), 30
    );
    EXPECT_EQ(pixel(cube, 2, 2), pixel(empty, 2, 2));
    EXPECT_EQ(pixel(cube, kWidth - 3, kHeight - 3), pixel(empty, kWidth - 3, kHeight - 3));
    const std::size_t covered = different_pixels(cube, empty);
    EXPECT_GT(covered, kWidth * kHeight / 6);
    EXPECT_LT(covered, kWidth * kHeight * 2 / 3);
}

TEST_F(RendererTest, LightsTheSidesOfACubeDifferently)
{
    const auto renderer = make_renderer();
    const Image cube = picture_of_cube(*renderer, 12);
    const auto top = pixel_at(cube, {0, 1, 0});
    const auto front = pixel_at(cube, {0, 0, 1});
    const auto side = pixel_at(cube, {-1, 0, 0});
    EXPECT_GT(difference(top, front), 15);
    EXPECT_GT(difference(front, side), 15);
    // A side has one colour: its normals do not bend at the edges.
    EXPECT_LE(difference(front, pixel_at(cube, {0.8F, 0.8F, 1})), 6);
    EXPECT_LE(difference(front, pixel_at(cube, {-0.8F, -0.8F, 1})), 6);
}

TEST_F(RendererTest, DrawsOnlyTheTrianglesThatWereUploaded)
{
    const auto renderer = make_renderer();
    const Image whole = picture_of_cube(*renderer, 12);
    const Image half = picture_of_cube(*renderer, 6);
    EXPECT_GT(different_pixels(whole, half), 100U);
    EXPECT_EQ(different_pixels(picture_of_cube(*renderer, 12), whole), 0U);
}

TEST_F(RendererTest, DrawsEdgesInTheGridDisplay)
{
    const Image surface = picture_of_cube(*make_renderer(false), 12);
    const Image lines = picture_of_cube(*make_renderer(true), 12);
    const std::size_t changed = different_pixels(surface, lines);
    EXPECT_GT(changed, 150U);
    EXPECT_LT(changed, kWidth * kHeight / 4);
}

TEST_F(RendererTest, RefusesASizeThatTheDriverCannotDraw)
{
    const auto renderer = Renderer::create({1U << 20, 1U << 20, false});
    ASSERT_FALSE(renderer.has_value());
    EXPECT_EQ(renderer.error().code, ErrorCode::Internal);
}

TEST(Png, IsWrittenWhole)
{
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("image" + std::to_string(::getpid()) + ".png");
    const Image image{2, 1, {255, 0, 0, 0, 0, 255}};
    ASSERT_TRUE(write_png(path, image).has_value());
    EXPECT_GT(std::filesystem::file_size(path), 60U);
    std::filesystem::remove(path);
    const auto failed = write_png("/nonexistent/image.png", image);
    ASSERT_FALSE(failed.has_value());
    EXPECT_EQ(failed.error().code, ErrorCode::IoError);
}

}  // namespace
}  // namespace vsplit::client
