#include "scene/appearance_chunk.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <span>
#include <string>
#include <utility>

namespace vsplit::scene {
namespace {

Appearance everything()
{
    Material plain;
    plain.name = "plain";
    Material full;
    full.base_color = {0.5F, 0.25F, 0.125F, 0.75F};
    full.metallic = 0.5F;
    full.roughness = 0.25F;
    full.emissive = {1.0F, 2.0F, 3.0F};
    full.normal_scale = -2.0F;
    full.occlusion_strength = 0.5F;
    full.alpha_mode = AlphaMode::Mask;
    full.alpha_cutoff = 0.25F;
    full.double_sided = true;
    full.base_color_texture = {1, 0, TextureWrap::Mirror, TextureWrap::Clamp};
    full.metallic_roughness_texture = {0, 7, TextureWrap::Repeat, TextureWrap::Repeat};
    full.normal_texture = {1, 1, TextureWrap::Clamp, TextureWrap::Mirror};
    full.occlusion_texture = {0, 0, TextureWrap::Repeat, TextureWrap::Clamp};
    full.emissive_texture = {1, 2, TextureWrap::Repeat, TextureWrap::Repeat};
    return {
        .materials = {plain, full},
        .groups = {{"body", 1}, {"", -1}, {"Räder", 0}},
        .images = {{"", 32768, 1, 4}, {"skin.png", 1024, 512, 3}},
    };
}

/// One material with one texture, as most models have.
Appearance usual()
{
    Appearance appearance;
    appearance.materials.emplace_back();
    appearance.materials[0].metallic = 0.0F;
    appearance.materials[0].base_color_texture.image = 0;
    appearance.groups.push_back({"", 0});
    appearance.images.push_back({"", 1024, 1024, 3});
    return appearance;
}

std::vector<std::byte> encoded(const Appearance& appearance)
{
    const auto bytes = encode_appearance(appearance);
    EXPECT_TRUE(bytes) << bytes.error().message;
    return *bytes;
}

TEST(AppearanceChunk, KeepsEverything)
{
    const auto read = decode_appearance(encoded(everything()));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, everything());
}

TEST(AppearanceChunk, KeepsNothing)
{
    const auto read = decode_appearance(encoded({}));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, Appearance{});
}

TEST(AppearanceChunk, IsSmallForOneTexturedMaterial)
{
    const auto bytes = encoded(usual());
    EXPECT_LE(bytes.size(), 100U);
    const auto read = decode_appearance(bytes);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, usual());
}

TEST(AppearanceChunk, LeavesNamesOutOnRequest)
{
    const auto bytes = encode_appearance(everything(), false);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto read = decode_appearance(*bytes);
    ASSERT_TRUE(read) << read.error().message;
    Appearance nameless = everything();
    nameless.materials[0].name.clear();
    nameless.groups[0].name.clear();
    nameless.groups[2].name.clear();
    nameless.images[1].name.clear();
    EXPECT_EQ(*read, nameless);
}

TEST(AppearanceChunk, MakesNamesAndFactorsFit)
{
    Appearance appearance = usual();
    appearance.materials[0].name = "a\nb\xFF" + std::string(2000, 'x');
    appearance.materials[0].base_color = {2.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), 1};
    appearance.materials[0].emissive = {std::numeric_limits<float>::infinity(), 0.0F, 0.0F};
    const auto read = decode_appearance(encoded(appearance));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->materials[0].name, "a?b?" + std::string(1020, 'x'));
    EXPECT_EQ(read->materials[0].base_color, (std::array<float, 4>{1.0F, 0.0F, 1.0F, 1.0F}));
    EXPECT_EQ(read->materials[0].emissive[0], 65504.0F);
}

TEST(AppearanceChunk, RefusesToWriteWhatDoesNotExist)
{
    Appearance image = usual();
    image.materials[0].normal_texture.image = 1;
    EXPECT_EQ(encode_appearance(image).error().code, ErrorCode::BadIndex);
    Appearance material = usual();
    material.groups[0].material = 1;
    EXPECT_EQ(encode_appearance(material).error().code, ErrorCode::BadIndex);
    Appearance size = usual();
    size.images[0].height = 0;
    EXPECT_EQ(encode_appearance(size).error().code, ErrorCode::BadIndex);
    Appearance many = usual();
    many.groups.resize(65537);
    EXPECT_EQ(encode_appearance(many).error().code, ErrorCode::InputTooLarge);
}

TEST(AppearanceChunk, KeepsToTheReadersLimits)
{
    const auto bytes = encoded(everything());
    for (const AppearanceLimits& limits : {
             AppearanceLimits{.max_materials = 1},
             AppearanceLimits{.max_groups = 2},
             AppearanceLimits{.max_images = 1},
             AppearanceLimits{.max_bytes = bytes.size() - 1},
             AppearanceLimits{.max_name_bytes = 3},
             AppearanceLimits{.max_image_side = 1024},
         })
    {
        EXPECT_FALSE(decode_appearance(bytes, limits));
    }
}

TEST(AppearanceChunk, RejectsEveryTruncation)
{
    for (const Appearance& appearance : {everything(), usual()})
    {
        const auto bytes = encoded(appearance);
        for (std::size_t length = 0; length < bytes.size(); ++length)
        {
            const auto read = decode_appearance(std::span(bytes).first(length));
            ASSERT_FALSE(read) << length;
            EXPECT_EQ(read.error().code, ErrorCode::BadChunk);
        }
    }
}

TEST(AppearanceChunk, ReadsOnlyWhatCouldHaveBeenWritten)
{
    std::mt19937 random(5);
    const auto bytes = encoded(everything());
    for (int round = 0; round < 20000; ++round)
    {
        auto changed = bytes;
        for (int i = 0; i < 2; ++i)
        {
            changed[random() % changed.size()] = std::byte(random() & 255U);
        }
        if (const auto read = decode_appearance(changed))
        {
            EXPECT_TRUE(encode_appearance(*read));
        }
    }
}

TEST(AppearanceChunk, GivesTheSameBytesAgain)
{
    EXPECT_EQ(encoded(everything()), encoded(everything()));
}

}  // namespace
}  // namespace vsplit::scene
