// Components that come when they become visible: what the encoder makes of them, what the decoder does.

#include "codec/encoded_samples.h"
#include "codec/shapes.h"
#include "codec/stream_decoder.h"
#include "codec/stream_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vsplit::test {
namespace {

using codec::ChunkInfo;
using proto::ChunkKind;

/// Triangles that touch no other one, `count` of them, small against the cloud that they make.
IndexedMesh soup(std::uint32_t count, unsigned seed)
{
    std::mt19937 random(seed);
    const auto number = [&] { return static_cast<double>(random() % 4096) / 4096.0; };
    IndexedMesh mesh;
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const std::array<double, 3> centre{number(), number(), number()};
        const double size = 0.02 + 0.1 * std::pow(number(), 4.0);
        for (std::uint32_t k = 0; k < 3; ++k)
        {
            mesh.positions.push_back(
                {centre[0] + size * number(),
                 centre[1] + size * number(),
                 centre[2] + size * number()}
            );
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// A sphere with two small ones and a shred beside it.
IndexedMesh sphere_and_specks()
{
    IndexedMesh speck = sphere(6, 6, 0.1, 4);
    for (auto& position : speck.positions)
    {
        position = {0.06 * position[0], 0.06 * position[1], 0.06 * position[2]};
    }
    IndexedMesh shred = triangle();
    for (auto& position : shred.positions)
    {
        position = {0.02 * position[0], 0.02 * position[1], 0.02 * position[2]};
    }
    const IndexedMesh specks = joined(joined(speck, speck, 0.4), shred, 0.7);
    return joined(sphere(20, 24, 0.03, 2), specks, 1.3);
}

std::vector<std::size_t> parts_chunks(const codec::StreamInfo& info)
{
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < info.chunks.size(); ++i)
    {
        if (info.chunks[i].kind == ChunkKind::Parts)
        {
            found.push_back(i);
        }
    }
    return found;
}

TEST(Parts, AreNotInTheBaseButInTheCompleteMesh)
{
    const EncodedSample sample = encode(sphere_and_specks());
    ASSERT_FALSE(parts_chunks(sample.info).empty());
    // What remains is one sphere.
    EXPECT_EQ(sample.info.chunks[0].faces, 2 * sample.info.chunks[0].vertices - 4);
    const Decoded decoded = decode(sample.file);
    ASSERT_TRUE(decoded.complete);
    EXPECT_EQ(face_set(decoded.last.mesh), face_set(sample.source));
}

TEST(Parts, LeaveWhatIsThereAsItIs)
{
    const EncodedSample sample = encode(sphere_and_specks());
    const Decoded decoded = decode(sample.file);
    for (const std::size_t c : parts_chunks(sample.info))
    {
        const GridMesh& before = decoded.chunks[c - 1].mesh;
        const GridMesh& after = decoded.chunks[c].mesh;
        ASSERT_LT(before.positions.size(), after.positions.size());
        ASSERT_LT(before.triangles.size(), after.triangles.size());
        EXPECT_EQ(decoded.chunks[c - 1].shift, decoded.chunks[c].shift);
        EXPECT_TRUE(
            std::equal(before.positions.begin(), before.positions.end(), after.positions.begin())
        );
        EXPECT_TRUE(
            std::equal(before.triangles.begin(), before.triangles.end(), after.triangles.begin())
        );
    }
}

TEST(Parts, TellOfTheirOwnTriangles)
{
    const EncodedSample sample = encode(sphere_and_specks());
    codec::StreamDecoder decoder;
    std::span<const std::byte> rest = sample.file;
    std::size_t seen = 0;
    while (!decoder.complete())
    {
        rest = rest.subspan(decoder.feed(rest).value());
        const std::uint32_t vertices = decoder.vertices();
        const std::uint32_t faces = decoder.faces();
        const std::uint64_t offset = decoder.decoded_bytes();
        const codec::Step step = decoder.step().value();
        const auto chunk = std::ranges::find(sample.info.chunks, offset, &ChunkInfo::offset);
        if (chunk == sample.info.chunks.end() || chunk->kind != ChunkKind::Parts)
        {
            continue;
        }
        ++seen;
        std::vector<Triangle> triangles(decoder.faces());
        decoder.write_triangles(triangles);
        std::uint32_t slot = faces;
        for (const codec::TriangleUpdate& update : step.triangles)
        {
            EXPECT_EQ(update.slot, slot);
            EXPECT_EQ(update.vertices, triangles[slot++]);
        }
        EXPECT_EQ(slot, decoder.faces());
        EXPECT_EQ(step.first_new_vertex, vertices);
        EXPECT_EQ(step.first_moved_vertex, vertices);
    }
    EXPECT_EQ(seen, parts_chunks(sample.info).size());
}

TEST(Parts, BoundTheBaseOfASoup)
{
    const EncodedSample sample = encode(soup(6000, 1), {.metric = precompute::Metric::Qem});
    EXPECT_LE(sample.info.levels[0].cumulative_bytes, 6000U);
    EXPECT_LE(sample.info.chunks[0].vertices, 800U);
    EXPECT_LE(sample.info.levels.size(), 40U);
    bool shares_level = false;
    for (const std::size_t c : parts_chunks(sample.info))
    {
        const ChunkInfo& chunk = sample.info.chunks[c];
        EXPECT_LE(chunk.vertices - sample.info.chunks[c - 1].vertices, 4096U);
        EXPECT_LE(chunk.bytes, proto::kTargetChunkBytes);
        shares_level = shares_level || !chunk.ends_level;
    }
    EXPECT_TRUE(shares_level);
    const Decoded decoded = decode(sample.file);
    ASSERT_TRUE(decoded.complete);
    EXPECT_EQ(face_set(decoded.last.mesh), face_set(sample.source));
}

TEST(Parts, AreMeasuredWhileTheyAreMissing)
{
    const EncodedSample sample = encode(sphere_and_specks());
    const auto& levels = sample.info.levels;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    {
        EXPECT_GE(levels[i].max_error, levels[i].rms_error);
        EXPECT_GT(levels[i].rms_error, 0.0);
    }
    // The farthest speck is two thirds of the sphere's radius away from it.
    EXPECT_GT(levels[0].max_error, 0.6);
}

TEST(Parts, StayOutOfMeshesOfOneComponent)
{
    EXPECT_TRUE(parts_chunks(encode(sphere(20, 24, 0.03, 2)).info).empty());
    EXPECT_TRUE(parts_chunks(encode(height_field(30, 30, 0.5, 4)).info).empty());
}

TEST(Parts, StayInTheBaseWhereLevelsHaveExactCounts)
{
    const EncodedSample sample = encode(sphere_and_specks(), {.level_vertices = {300U, 120U}});
    EXPECT_TRUE(parts_chunks(sample.info).empty());
}

TEST(Parts, StayWhereTheyAreToBeKept)
{
    const IndexedMesh mesh = sphere_and_specks();
    precompute::EncodeOptions options;
    options.importance.assign(mesh.positions.size(), 0.0F);
    options.importance.back() = 1.0F;
    const EncodedSample sample = encode(mesh, options);
    const Decoded decoded = decode(sample.file);
    ASSERT_TRUE(decoded.complete);
    const auto& base = decoded.levels[0].mesh.positions;
    const double cell = sample.info.grid.cell * (1 << decoded.levels[0].shift);
    const bool has_shred = std::ranges::any_of(base, [&](const auto& position) {
        return sample.info.grid.origin[0] + position[0] * cell > 1.9;
    });
    EXPECT_TRUE(has_shred);
}

TEST(Parts, AreRefusedWhenTheyLieOutsideOfTheGrid)
{
    const EncodedSample sample = encode(sphere_and_specks());
    StreamParts parts = take_apart(sample.file);
    const std::size_t c = parts_chunks(sample.info).front();
    std::size_t refused = 0;
    for (std::size_t i = 0; i < parts.chunks[c].size(); ++i)
    {
        StreamParts changed = parts;
        changed.chunks[c][i] ^= std::byte{0x3C};
        const Decoded decoded = decode(put_together(changed));
        if (decoded.error)
        {
            ++refused;
            EXPECT_EQ(decoded.error->code, ErrorCode::BadChunk);
            EXPECT_GE(decoded.chunks.size(), c);
        }
    }
    EXPECT_GT(refused, 0U);
}

}  // namespace
}  // namespace vsplit::test
