// Attributes come back as they were encoded, at the last level exactly, and every level is whole.

#include "codec/attribute_coder.h"
#include "codec/attributed_samples.h"
#include "codec/shapes.h"
#include "core/byte_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace vsplit::test {
namespace {

using codec::AttributeInfo;
using codec::LevelAttributes;
using proto::ChunkKind;

Decoded decode_whole(const Bytes& file)
{
    Decoded decoded = decode(file);
    EXPECT_FALSE(decoded.error.has_value()) << describe(*decoded.error);
    EXPECT_TRUE(decoded.complete);
    return decoded;
}

void expect_round_trip(const AttributedSample& sample)
{
    const Decoded decoded = decode_whole(sample.file);
    ASSERT_FALSE(decoded.attributes.empty());
    EXPECT_EQ(face_rows(sample.info, decoded), face_rows(sample));
    EXPECT_EQ(decoded.attributes.back().attributes.wedge_vertices.size(), sample.info.wedge_count);
}

TEST(AttributeStream, ComesBackForEveryShapeGrownAndSplit)
{
    for (const TexturedShape& shape : textured_shapes())
    {
        for (const bool grown : {true, false})
        {
            SCOPED_TRACE(::testing::Message() << shape.name << (grown ? ", grown" : ", split"));
            expect_round_trip(encode(attributed(shape, every_kind()), {.grow_last_level = grown}));
        }
    }
}

TEST(AttributeStream, HasWholeLevelsWhoseWedgesStay)
{
    for (const TexturedShape& shape : textured_shapes())
    {
        const AttributedSample sample =
            encode(attributed(shape, every_kind()), {.grow_last_level = false});
        const Decoded decoded = decode_whole(sample.file);
        const LevelAttributes* before = nullptr;
        for (const auto& [level, shown] : decoded.attributes)
        {
            const auto& triangles = decoded.levels[level].mesh.triangles;
            ASSERT_EQ(shown.wedges.size(), triangles.size());
            for (std::size_t slot = 0; slot < triangles.size(); ++slot)
            {
                for (std::size_t k = 0; k < 3; ++k)
                {
                    ASSERT_EQ(shown.wedge_vertices[shown.wedges[slot][k]], triangles[slot][k]);
                }
            }
            const auto starts_with = [](const auto& all, const auto& first) {
                return all.size() >= first.size() &&
                       std::equal(first.begin(), first.end(), all.begin());
            };
            if (before != nullptr)
            {
                EXPECT_TRUE(starts_with(shown.wedge_vertices, before->wedge_vertices));
                EXPECT_TRUE(starts_with(shown.values[0], before->values[0]));
            }
            before = &shown;
        }
        EXPECT_EQ(decoded.attributes.back().level + 1, decoded.levels.size());
    }
}

TEST(AttributeStream, MayHoldGroupsAlone)
{
    const TexturedShape shape = textured("torus", torus(20, 12, 0.05, 1), 4, 0.0, 1);
    const AttributedSample sample = encode(attributed(shape, {}));
    EXPECT_TRUE(sample.info.attributes.empty());
    expect_round_trip(sample);
}

TEST(AttributeStream, MayHoldAttributesWithoutGroups)
{
    precompute::EncodeInput input =
        attributed(textured("sphere", sphere(12, 14, 0.05, 1), 3, 0.1, 2), every_kind());
    input.groups.clear();
    const AttributedSample sample = encode(input);
    expect_round_trip(sample);
    EXPECT_TRUE(decode(sample.file).attributes.back().attributes.groups.empty());
}

TEST(AttributeStream, MayHoldAsManyAttributesAsThereCanBe)
{
    std::vector<AttributeInfo> infos(
        proto::kMaxAttributes, {.kind = AttributeKind::Scalar, .components = 4, .bits = 16}
    );
    infos[3] = {.kind = AttributeKind::Normal, .components = 3, .bits = 16};
    infos[9] = {.kind = AttributeKind::Normal, .set = 1, .components = 3, .bits = 2};
    infos[12].bits = 1;
    const TexturedShape shape = textured("sheet", height_field(9, 8, 0.4, 1), 3, 0.1, 3);
    expect_round_trip(encode(attributed(shape, infos)));
}

TEST(AttributeStream, MayBeAsSmallAsOneTriangle)
{
    const TexturedShape shape = textured("triangle", triangle(), 1, 0.0, 1);
    expect_round_trip(encode(attributed(shape, every_kind())));
}

TEST(AttributeStream, HoldsHubsWithManyWedges)
{
    const TexturedShape shape = textured("cone", double_cone(300), 150, 0.2, 1);
    expect_round_trip(encode(attributed(shape, every_kind())));
    expect_round_trip(encode(attributed(shape, every_kind()), {.grow_last_level = false}));
}

TEST(AttributeStream, IsTheSameEveryTime)
{
    const auto input =
        attributed(textured("torus", torus(20, 12, 0.05, 1), 4, 0.1, 1), every_kind());
    EXPECT_EQ(encode(input).file, encode(input, {.threads = 3}).file);
}

TEST(AttributeStream, IsCutIntoChunksThatAreNotTooLong)
{
    std::vector<AttributeInfo> infos(
        4, {.kind = AttributeKind::Scalar, .components = 4, .bits = 16}
    );
    infos[3] = {.kind = AttributeKind::Normal, .components = 3, .bits = 16};
    precompute::EncodeInput input =
        attributed(textured("torus", torus(120, 90, 0.0, 1), 5, 0.05, 1), infos);
    unsigned random = 1;
    for (auto& values : input.values)
    {
        for (std::int32_t& number : values)
        {
            random = random * 1664525U + 1013904223U;
            number = static_cast<std::int32_t>(random >> 16);
        }
    }
    // Normals of 16 bits lie within 0 .. 65534.
    for (std::int32_t& number : input.values[3])
    {
        number = std::min(number, 65534);
    }
    const AttributedSample sample = encode(input, {.threads = 2});
    std::size_t chunks = 0;
    for (const codec::ChunkInfo& chunk : sample.info.chunks)
    {
        if (chunk.kind == ChunkKind::Attributes)
        {
            EXPECT_LE(chunk.bytes, proto::kTargetChunkBytes);
            ++chunks;
        }
    }
    EXPECT_GT(chunks, 6U);
    expect_round_trip(sample);
}

TEST(AttributeStream, WaitsForTheRestOfEveryTruncation)
{
    const AttributedSample sample =
        encode(attributed(textured("sphere", sphere(8, 8, 0.05, 1), 3, 0.1, 2), every_kind()));
    const Decoded whole = decode_whole(sample.file);
    for (std::size_t length = 0; length < sample.file.size(); ++length)
    {
        const Decoded decoded = decode(std::span(sample.file).first(length));
        ASSERT_FALSE(decoded.error.has_value()) << length;
        ASSERT_FALSE(decoded.complete) << length;
        ASSERT_LE(decoded.attributes.size(), whole.attributes.size());
    }
}

TEST(AttributeStream, IsSkippedOnDemand)
{
    const AttributedSample sample =
        encode(attributed(textured("sphere", sphere(8, 8, 0.05, 1), 3, 0.1, 2), every_kind()));
    const Decoded decoded = decode(sample.file, {.attributes = false});
    EXPECT_TRUE(decoded.complete);
    EXPECT_TRUE(decoded.attributes.empty());
    EXPECT_EQ(decoded.levels, decode(sample.file).levels);
}

/// The complete mesh of a stream with its wedges, and the normals that were encoded.
struct NormalSample
{
    AttributeInfo info{.kind = AttributeKind::Normal, .components = 3, .bits = 8};
    codec::LevelMesh mesh;
    LevelAttributes shown;
    std::vector<std::int32_t> normals;
};

NormalSample normal_sample()
{
    NormalSample sample;
    const AttributedSample encoded = encode(
        attributed(textured("sheet", height_field(16, 15, 0.4, 1), 3, 0.05, 2), {sample.info})
    );
    codec::StreamDecoder decoder;
    auto rest = std::span<const std::byte>(encoded.file);
    while (!decoder.complete())
    {
        rest = rest.subspan(decoder.feed(rest).value());
        EXPECT_TRUE(decoder.step().has_value());
    }
    sample.mesh = decoder.level_mesh();
    sample.shown = *decoder.attributes();
    sample.normals = sample.shown.values[0];
    return sample;
}

TEST(NormalCoder, GivesNormalsBackInEveryStyle)
{
    const NormalSample sample = normal_sample();
    for (std::uint8_t choice = 0; choice < 32; ++choice)
    {
        const codec::NormalStyle style{
            static_cast<codec::NormalWeight>(choice & 3U), static_cast<std::uint8_t>(choice >> 2U)};
        codec::NormalCoder coder(sample.info, sample.mesh, sample.shown);
        codec::BitEncoder bits;
        coder.begin(bits, style);
        ASSERT_TRUE(coder.run(bits, coder.left(), sample.normals).has_value());
        ByteWriter bytes;
        bits.finish(bytes);

        codec::NormalCoder decoder(sample.info, sample.mesh, sample.shown);
        codec::BitDecoder read;
        ASSERT_TRUE(read.start(bytes.view()).has_value());
        decoder.begin(read, {});
        ASSERT_TRUE(decoder.run(read, decoder.left(), {}).has_value());
        ASSERT_TRUE(read.finish().has_value());
        EXPECT_EQ(decoder.values(), sample.normals) << int{choice};
    }
}

TEST(Octahedron, FoldsEveryPointBackToWhereItWas)
{
    constexpr std::int32_t kHalf = 7;
    for (std::int32_t x = -kHalf; x <= kHalf; ++x)
    {
        for (std::int32_t y = -kHalf + std::abs(x); y <= kHalf - std::abs(x); ++y)
        {
            for (const std::int32_t sign : {1, -1})
            {
                const std::int32_t z = sign * (kHalf - std::abs(x) - std::abs(y));
                const codec::OctaPoint point{x, y, z};
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    const codec::OctaSide side{axis, sign};
                    EXPECT_EQ(codec::fold(codec::unfold(point, side, kHalf), side, kHalf), point);
                }
                const codec::Double3 exact{
                    static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
                EXPECT_EQ(codec::octa_point(exact, kHalf), point);
            }
        }
    }
}

}  // namespace
}  // namespace vsplit::test
