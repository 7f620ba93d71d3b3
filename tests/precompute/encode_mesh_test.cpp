#include "precompute/encode_mesh.h"

#include "codec/encoded_samples.h"
#include "codec/shapes.h"
#include "codec/stream_parts.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"
#include "precompute/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vsplit::test {
namespace {

using precompute::EncodeOptions;
using precompute::Metric;

/// Checks that a stream decodes to its source: same faces at the same places, same vertices.
void expect_exact(const EncodedSample& sample)
{
    const Decoded decoded = decode(sample.file);
    ASSERT_FALSE(decoded.error.has_value()) << describe(*decoded.error);
    ASSERT_TRUE(decoded.complete);
    ASSERT_EQ(face_set(decoded.last.mesh), face_set(sample.source));
    auto wanted = sample.source.positions;
    auto positions = decoded.last.mesh.positions;
    std::ranges::sort(wanted);
    std::ranges::sort(positions);
    ASSERT_EQ(positions, wanted);
}

class EncodeAsset : public ::testing::TestWithParam<std::string>
{
protected:
    [[nodiscard]] static IndexedMesh mesh()
    {
        return precompute::read_mesh(VSPLIT_SOURCE_DIR "/assets/" + GetParam() + ".ply").value();
    }
};

INSTANTIATE_TEST_SUITE_P(
    Assets,
    EncodeAsset,
    ::testing::Values("bone", "beast", "bracket", "terrain", "pair", "dirty"),
    [](const auto& instance) { return instance.param; }
);

TEST_P(EncodeAsset, IsExactWithEveryMetric)
{
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        SCOPED_TRACE(name);
        expect_exact(encode(mesh(), {.metric = metric, .threads = 2}));
    }
}

TEST_P(EncodeAsset, IsExactAtEveryPrecision)
{
    for (const int bits : {8, 16, 20})
    {
        SCOPED_TRACE(bits);
        const EncodedSample sample =
            encode(mesh(), {.position_bits = bits, .metric = Metric::Qem, .threads = 2});
        EXPECT_EQ(sample.info.grid.bits, bits);
        expect_exact(sample);
    }
}

TEST_P(EncodeAsset, NeverCracks)
{
    const EncodedSample sample = encode(mesh());
    const Decoded decoded = decode(sample.file);
    const std::uint32_t base = sample.info.levels.front().vertices;
    ASSERT_EQ(decoded.stitches.empty(), sample.stitches.empty());
    for (std::uint32_t v = 0; v < decoded.stitches.size(); ++v)
    {
        const std::uint32_t other = decoded.stitches[v];
        if (other == v)
        {
            continue;
        }
        // Both are there from the base on, and at one place at every level.
        ASSERT_LT(v, base);
        for (const Snapshot& level : decoded.levels)
        {
            ASSERT_EQ(level.mesh.positions[v], level.mesh.positions[other]);
        }
    }
}

TEST_P(EncodeAsset, HasErrorsThatFall)
{
    const codec::StreamInfo info = encode(mesh()).info;
    ASSERT_GT(info.levels.size(), 4U);
    const double diagonal = info.diagonal();
    EXPECT_LT(info.levels.front().rms_error, 0.06 * diagonal);
    EXPECT_LT(info.levels.back().rms_error, info.levels.front().rms_error * 0.1);
    for (const codec::LevelInfo& level : info.levels)
    {
        EXPECT_LE(level.rms_error, level.max_error);
        EXPECT_GT(level.rms_error, 0.0);  // even the last one is rounded to the grid
    }
}

TEST(EncodeMesh, AimsForTheBaseThatIsAskedFor)
{
    const IndexedMesh mesh = torus(40, 30, 0.02, 1);
    for (const std::uint32_t base : {20U, 64U, 100U, 500U, 1199U, 1200U, 5000U})
    {
        const EncodedSample sample = encode(mesh, {.base_vertices = base});
        EXPECT_EQ(sample.info.levels.front().vertices, std::min(base, 1200U));
        expect_exact(sample);
    }
}

TEST(EncodeMesh, HasLevelsOfTheSizesThatAreAskedFor)
{
    const IndexedMesh mesh = torus(40, 30, 0.02, 1);
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        SCOPED_TRACE(name);
        const std::vector<std::uint32_t> wanted{300, 1199, 70, 650, 5, 5000, 299};
        const EncodedSample sample = encode(mesh, {.metric = metric, .level_vertices = wanted});
        std::vector<std::uint32_t> sizes;
        for (const codec::LevelInfo& level : sample.info.levels)
        {
            sizes.push_back(level.vertices);
        }
        EXPECT_THAT(sizes, ::testing::IsSupersetOf({12U, 70U, 299U, 300U, 650U, 1199U, 1200U}));
        expect_exact(sample);
    }
}

TEST(EncodeMesh, StopsWhereTopologyForbidsASmallerBase)
{
    IndexedMesh many = tetrahedron();
    for (int i = 1; i < 60; ++i)
    {
        many = joined(many, i % 2 == 0 ? tetrahedron() : octahedron(), 2.0 * i);
    }
    const EncodedSample sample = encode(many, {.base_vertices = 4});
    EXPECT_GE(sample.info.levels.front().vertices, 240U);
    expect_exact(sample);
}

TEST(EncodeMesh, RefusesAMeshWithoutTriangles)
{
    const auto encoded = precompute::encode_mesh({}, {}, {});
    ASSERT_FALSE(encoded.has_value());
    EXPECT_EQ(encoded.error().code, ErrorCode::EmptyMesh);
}

TEST(EncodeMesh, SaysWhyItRefusesAMeshThatIsNoManifold)
{
    const IndexedMesh whole = torus(9, 8, 0.0, 1);
    IndexedMesh mesh = whole;
    std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        const auto encoded = precompute::encode_mesh(mesh, {}, {.metric = metric});
        ASSERT_FALSE(encoded.has_value()) << name;
        EXPECT_EQ(encoded.error().code, ErrorCode::UnsupportedInput) << name;
        EXPECT_THAT(encoded.error().message, ::testing::HasSubstr("opposite direction")) << name;
    }
    mesh = whole;
    mesh.positions.push_back({2, 2, 2});
    const auto encoded = precompute::encode_mesh(mesh, {}, {});
    ASSERT_FALSE(encoded.has_value());
    EXPECT_THAT(encoded.error().message, ::testing::HasSubstr("no face uses vertex 72"));
    mesh.triangles.push_back({0, 1, 73});
    EXPECT_EQ(precompute::encode_mesh(mesh, {}, {}).error().code, ErrorCode::BadIndex);
}

TEST(EncodeMesh, GivesTheSameBytesForAnyNumberOfThreads)
{
    const IndexedMesh mesh = torus(60, 50, 0.02, 1);
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        const auto one = precompute::encode_mesh(mesh, {}, {.metric = metric, .threads = 1});
        const auto two = precompute::encode_mesh(mesh, {}, {.metric = metric, .threads = 2});
        ASSERT_TRUE(one.has_value() && two.has_value()) << name;
        EXPECT_EQ(one->file, two->file) << name;
    }
}

TEST(EncodeMesh, TellsItsProgress)
{
    std::vector<std::string> stages;
    double share_before = 0.0;
    const auto encoded = precompute::encode_mesh(
        torus(40, 30, 0.02, 1),
        {},
        {},
        [&](std::string_view stage, double share) {
            EXPECT_GE(share, 0.0);
            EXPECT_LE(share, 1.0);
            if (stages.empty() || stages.back() != stage)
            {
                stages.emplace_back(stage);
                share_before = 0.0;
            }
            EXPECT_GE(share, share_before);
            share_before = share;
        }
    );
    ASSERT_TRUE(encoded.has_value());
    EXPECT_THAT(stages, ::testing::ElementsAre("collapse", "measure", "code"));
}

TEST(EncodeMesh, CutsLargeLevelsIntoSmallChunks)
{
    const EncodedSample sample = encode(
        height_field(390, 385, 0.4, 7), {.position_bits = 20, .metric = Metric::Qem, .threads = 2}
    );
    EXPECT_EQ(sample.info.vertex_count, 150150U);
    for (const codec::ChunkInfo& chunk : sample.info.chunks)
    {
        EXPECT_LE(chunk.bytes, proto::kTargetChunkBytes);
    }
    codec::StreamDecoder decoder;
    std::span<const std::byte> rest = sample.file;
    while (!decoder.complete())
    {
        rest = rest.subspan(decoder.feed(rest).value());
        ASSERT_TRUE(decoder.step().has_value());
    }
    EXPECT_EQ(face_set(codec::extract_grid_mesh(decoder)), face_set(sample.source));
}

/// A mesh that depends on the seed alone: some kind of shape, with noise, holes and debris.
IndexedMesh random_mesh(unsigned seed)
{
    std::mt19937 random(seed);
    const auto below = [&](unsigned count) { return static_cast<unsigned>(random() % count); };
    const double noise = 0.02 * below(40);
    IndexedMesh mesh;
    switch (below(4))
    {
        case 0:
            mesh = torus(3 + below(20), 3 + below(20), noise, seed);
            break;
        case 1:
            mesh = sphere(2 + below(15), 3 + below(20), noise, seed);
            break;
        case 2:
            mesh = height_field(2 + below(25), 2 + below(25), 4.0 * noise, seed);
            break;
        default:
            mesh =
                joined(sphere(3 + below(9), 3 + below(9), noise, seed), strip(1 + below(30)), 0.5);
            break;
    }
    if (below(2) == 0)
    {
        mesh = with_holes(mesh, 0.01 * below(50), seed + 1);
    }
    if (below(4) == 0)
    {
        // Vertices fall together, which repair welds and cuts.
        for (auto& position : mesh.positions)
        {
            for (double& coordinate : position)
            {
                coordinate = std::round(coordinate * 2.0) / 2.0;
            }
        }
    }
    return mesh;
}

TEST(EncodeMesh, GrowsInSeveralChunks)
{
    const EncodedSample sample = encode(
        sphere(200, 300, 0.0, 1), {.position_bits = 20, .metric = Metric::Qem, .threads = 2}
    );
    const auto grows = [](const codec::ChunkInfo& chunk) {
        return chunk.kind == proto::ChunkKind::Growth;
    };
    EXPECT_GT(std::ranges::count_if(sample.info.chunks, grows), 1);
    EXPECT_TRUE(grows(sample.info.chunks.back()));
    for (const codec::ChunkInfo& chunk : sample.info.chunks)
    {
        EXPECT_LE(chunk.bytes, proto::kTargetChunkBytes);
    }
    expect_exact(sample);
}

TEST(EncodeMesh, IsExactForRandomMeshes)
{
    for (unsigned seed = 0; seed < 250; ++seed)
    {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        const IndexedMesh mesh = random_mesh(seed);
        const auto& [metric, name] = precompute::kMetricNames[seed % 6];
        const EncodeOptions options{
            .position_bits = 8 + static_cast<int>(seed % 13),
            .metric = metric,
            .base_vertices = seed % 3 == 0 ? 4 + seed % 50 : 0,
        };
        if (!precompute::repair_mesh(mesh))
        {
            continue;  // every face fell together
        }
        ASSERT_NO_FATAL_FAILURE(expect_exact(encode(mesh, options)));
    }
}

TEST(EncodeMesh, BearsExtremeGeometry)
{
    const IndexedMesh shape = torus(20, 12, 0.05, 1);
    const auto scaled = [&](double x, double y, double z, double offset) {
        IndexedMesh mesh = shape;
        for (auto& position : mesh.positions)
        {
            position = {position[0] * x + offset, position[1] * y, position[2] * z};
        }
        return mesh;
    };
    expect_exact(encode(scaled(1e-30, 1e-30, 1e-30, 0.0)));
    expect_exact(encode(scaled(1e30, 1e30, 1e30, 0.0)));
    expect_exact(encode(scaled(1.0, 1.0, 1.0, 1e9)));
    expect_exact(encode(scaled(1.0, 1e-6, 1e-6, 0.0)));  // nearly a line
    expect_exact(encode(scaled(1.0, 1.0, 0.0, 0.0)));    // flat and folded over
    const auto flat = height_field(20, 20, 0.0, 3);
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        SCOPED_TRACE(name);
        IndexedMesh plane = flat;
        for (auto& position : plane.positions)
        {
            position[2] = 5.0;
        }
        expect_exact(encode(plane, {.metric = metric}));
        expect_exact(encode(scaled(1e-9, 1e-9, 1.0, 0.0), {.metric = metric}));
    }
}

}  // namespace
}  // namespace vsplit::test
