#include "precompute/chunk_order.h"

#include "picture/picture_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace vsplit::test {
namespace {

using precompute::ChunkOrder;
using precompute::OrderOptions;
using precompute::OrderSource;
using precompute::OrderStep;

/// Orders by small pictures: the tests are about choices, not about what is seen.
Result<ChunkOrder> ordered(const OrderSource& source, OrderOptions options = {})
{
    options.picture_side = 96;
    return precompute::order_chunks(source, options);
}

/// An image whose detail shows when it is larger.
Raster noise(std::uint32_t side, std::uint8_t amount)
{
    Raster image{side, side, 3, {}};
    std::minstd_rand random(11);
    for (std::size_t i = 0; i < std::size_t{3} * side * side; ++i)
    {
        const auto value = static_cast<int>(random() % 255) - 127;
        image.pixels.push_back(static_cast<std::uint8_t>(128 + value * amount / 255));
    }
    return image;
}

Raster reduced(const Raster& image, std::uint32_t factor)
{
    Raster result{image.width / factor, image.height / factor, 3, {}};
    for (std::uint32_t y = 0; y < result.height; ++y)
    {
        for (std::uint32_t x = 0; x < result.width; ++x)
        {
            const std::size_t place = 3 * (std::size_t{y} * factor * image.width + x * factor);
            result.pixels.insert(
                result.pixels.end(), &image.pixels[place], &image.pixels[place + 3]
            );
        }
    }
    return result;
}

/// A sphere with texture coordinates.
Surface globe(std::uint32_t rings)
{
    Surface surface = cut_sphere(rings, 2 * rings, 0.0);
    SurfaceAttribute coordinates;
    for (const auto& position : surface.mesh.positions)
    {
        coordinates.values.push_back(static_cast<float>(position[0] / 2.0 + 0.5));
        coordinates.values.push_back(static_cast<float>(position[1] / 2.0 + 0.5));
    }
    coordinates.corners = surface.mesh.triangles;
    surface.attributes.push_back(coordinates);
    return surface;
}

/// A textured globe of six levels and five image chunks.
struct Sample
{
    explicit Sample(std::uint8_t detail) : images{noise(64, detail)}
    {
        appearance.groups.push_back({"", 0});
        appearance.materials.emplace_back().base_color_texture.image = 0;
        appearance.images.emplace_back();
        source.original = &original;
        source.appearance = &appearance;
        source.original_images = images;
        source.stage_bytes = {300, 500, 1000, 2000, 4000, 8000};
        source.texture_bytes = {{200, 400, 800, 1600, 3200}};
        source.stage = [this](std::uint32_t stage) -> Result<Surface> {
            ++drawn_stages;
            return globe(3U << stage);
        };
        source.image = [this](std::uint32_t, std::uint32_t chunks) -> Result<Raster> {
            return reduced(images[0], 1U << (5 - chunks));
        };
    }

    Surface original = globe(96);
    std::vector<Raster> images;
    Appearance appearance;
    OrderSource source;
    int drawn_stages = 0;
};

std::vector<std::uint32_t> indices_of(const ChunkOrder& order, std::int32_t image)
{
    std::vector<std::uint32_t> indices;
    for (const OrderStep& step : order.steps)
    {
        if (step.image == image)
        {
            indices.push_back(step.index);
        }
    }
    return indices;
}

TEST(ChunkOrder, HasEverythingOnceAndInItsOwnOrder)
{
    Sample sample(200);
    const auto order = ordered(sample.source);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->steps.front().image, OrderStep::kGeometry);
    EXPECT_THAT(indices_of(*order, OrderStep::kGeometry), ::testing::ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_THAT(indices_of(*order, 0), ::testing::ElementsAre(0, 1, 2, 3, 4));
    EXPECT_EQ(order->steps.size(), 11U);
}

TEST(ChunkOrder, SendsWhatIsSeenFirst)
{
    Sample plain(4);   // hardly any detail: the shape matters
    Sample rich(255);  // nothing but detail
    const auto of_plain = ordered(plain.source);
    const auto of_rich = ordered(rich.source);
    ASSERT_TRUE(of_plain && of_rich);
    EXPECT_GT(of_plain->stage_before(0, 4), of_rich->stage_before(0, 4));
    EXPECT_LT(of_rich->stage_before(0, 4), 5U);
}

TEST(ChunkOrder, LowersTheErrorToThatOfTheLastState)
{
    Sample sample(160);
    const auto order = ordered(sample.source);
    ASSERT_TRUE(order);
    EXPECT_LT(order->steps.back().error, order->steps.front().error / 20.0);
    EXPECT_TRUE(order->steps.back().measured);
}

TEST(ChunkOrder, BeatsSendingOneAfterTheOther)
{
    Sample sample(160);
    const auto order = ordered(sample.source);
    ASSERT_TRUE(order);
    // The area under the error, over bytes: of the order, of all levels first, of all chunks first.
    double area = 0.0;
    for (std::size_t i = 1; i < order->steps.size(); ++i)
    {
        area += order->steps[i - 1].error * static_cast<double>(order->steps[i].bytes);
    }
    OrderSource alone = sample.source;
    alone.texture_bytes = {{}};
    const auto levels = ordered(alone);
    ASSERT_TRUE(levels);
    double separate = 0.0;
    for (std::size_t i = 1; i < levels->steps.size(); ++i)
    {
        separate += levels->steps[i - 1].error * static_cast<double>(levels->steps[i].bytes);
    }
    separate += levels->steps.back().error * 1000.0;  // the first two chunks of five, at least
    EXPECT_LT(area, separate);
}

TEST(ChunkOrder, KeepsToTheBoundsOfItsOptions)
{
    Sample sample(160);
    OrderOptions options;
    options.most_states = 6;
    options.most_pictures = 4;
    const auto order = ordered(sample.source, options);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->steps.size(), 11U);
    EXPECT_LE(sample.drawn_stages, 6);
}

TEST(ChunkOrder, JudgesImagesThatAreNotDrawnByThemselves)
{
    Sample sample(160);
    sample.appearance.materials[0].base_color_texture.image = -1;
    sample.appearance.materials[0].normal_texture.image = 0;
    const auto order = ordered(sample.source);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->steps.size(), 11U);
    EXPECT_LT(order->stage_before(0, 0), 5U);
}

TEST(ChunkOrder, IsTheSameEveryTime)
{
    Sample a(160), b(160);
    const auto first = ordered(a.source);
    const auto second = ordered(b.source);
    ASSERT_TRUE(first && second);
    ASSERT_EQ(first->steps.size(), second->steps.size());
    for (std::size_t i = 0; i < first->steps.size(); ++i)
    {
        EXPECT_EQ(first->steps[i].image, second->steps[i].image);
        EXPECT_EQ(first->steps[i].error, second->steps[i].error);
    }
}

TEST(ChunkOrder, PassesErrorsOn)
{
    Sample sample(160);
    sample.source.image = [](std::uint32_t, std::uint32_t) -> Result<Raster> {
        return fail(ErrorCode::BadChunk, "no image");
    };
    const auto order = ordered(sample.source);
    ASSERT_FALSE(order);
    EXPECT_EQ(order.error().code, ErrorCode::BadChunk);
}

}  // namespace
}  // namespace vsplit::test
