#include "codec/base_mesh_decoder.h"
#include "codec/base_mesh_encoder.h"
#include "codec/shapes.h"
#include "mesh/quantization_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace vsplit::test {
namespace {

using codec::EncodedBase;

constexpr std::array<std::int32_t, 3> kExtent{4095, 4095, 4095};

/// Rounds a shape to a grid of 2^bits points an axis.
GridMesh on_grid(const IndexedMesh& mesh, int bits)
{
    QuantizationGrid grid = make_grid(mesh.positions, 12);
    GridMesh fine = quantize(grid, mesh);
    for (auto& position : fine.positions)
    {
        std::ranges::transform(position, position.begin(), [&](std::int32_t x) {
            return x >> (12 - bits);
        });
    }
    return fine;
}

std::uint32_t size_of(const auto& list)
{
    return static_cast<std::uint32_t>(list.size());
}

/// Codes a mesh with the codec that a test is about.
Result<EncodedBase> encode(const GridMesh& base, int codec)
{
    return codec == proto::kSmallBaseCodec ? codec::encode_small_base(base, kExtent)
                                           : codec::encode_draco_base(base);
}

Result<GridMesh> decode(
    std::span<const std::byte> bytes, int codec, std::uint32_t vertices, std::uint32_t faces
)
{
    return codec == proto::kSmallBaseCodec
               ? codec::decode_small_base(bytes, vertices, faces, kExtent)
               : codec::decode_draco_base(bytes, vertices, faces, 4095);
}

/// Codes a mesh and checks that the decoder gets it, renumbered as the encoder says.
void expect_round_trip(const GridMesh& base, int codec)
{
    const auto encoded = encode(base, codec);
    ASSERT_TRUE(encoded.has_value()) << describe(encoded.error());
    EXPECT_EQ(encoded->codec, codec);
    const auto decoded =
        decode(encoded->bytes, codec, size_of(base.positions), size_of(base.triangles));
    ASSERT_TRUE(decoded.has_value()) << describe(decoded.error());
    EXPECT_EQ(decoded->positions, encoded->decoded.positions);
    EXPECT_EQ(decoded->triangles, encoded->decoded.triangles);

    ASSERT_EQ(encoded->vertices.size(), base.positions.size());
    std::vector<std::uint32_t> all = encoded->vertices;
    std::ranges::sort(all);
    for (std::uint32_t v = 0; v < all.size(); ++v)
    {
        EXPECT_EQ(all[v], v);  // a permutation
        EXPECT_EQ(decoded->positions[v], base.positions[encoded->vertices[v]]);
    }
    // With the vertices named alike the triangles are the same, whatever their positions.
    const auto by_index = [&](std::vector<Triangle> triangles, bool rename) {
        for (Triangle& t : triangles)
        {
            for (std::uint32_t& v : t)
            {
                v = rename ? encoded->vertices[v] : v;
            }
            std::ranges::rotate(t, std::ranges::min_element(t));
        }
        std::ranges::sort(triangles);
        return triangles;
    };
    EXPECT_EQ(by_index(decoded->triangles, true), by_index(base.triangles, false));
}

/// Both codecs.
class BaseMesh : public ::testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(
    Codecs, BaseMesh, ::testing::Values(int{proto::kDracoBaseCodec}, int{proto::kSmallBaseCodec})
);

TEST_P(BaseMesh, ComesBack)
{
    for (const IndexedMesh& shape :
         {triangle(),
          tetrahedron(),
          octahedron(),
          strip(1),
          strip(20),
          fan(3),
          fan(400),
          double_cone(400),
          sphere(6, 7, 0.1, 1),
          torus(8, 6, 0.1, 2),
          height_field(9, 8, 0.5, 3)})
    {
        SCOPED_TRACE(shape.positions.size());
        expect_round_trip(on_grid(shape, 12), GetParam());
    }
}

TEST_P(BaseMesh, ComesBackFromAGridOnWhichVerticesCoincide)
{
    for (const int bits : {0, 1, 2, 3})
    {
        SCOPED_TRACE(bits);
        expect_round_trip(on_grid(tetrahedron(), bits), GetParam());
        expect_round_trip(on_grid(double_cone(30), bits), GetParam());
        expect_round_trip(on_grid(sphere(9, 10, 0.1, 1), bits), GetParam());
        expect_round_trip(on_grid(torus(9, 7, 0.1, 2), bits), GetParam());
        expect_round_trip(on_grid(height_field(9, 8, 0.5, 3), bits), GetParam());
    }
}

TEST_P(BaseMesh, ComesBackInSeveralComponents)
{
    IndexedMesh many = tetrahedron();
    for (int i = 1; i < 30; ++i)
    {
        many = joined(
            many,
            i % 3 == 0   ? octahedron()
            : i % 3 == 1 ? triangle()
                         : strip(3),
            4.0 * i
        );
    }
    expect_round_trip(on_grid(many, 12), GetParam());
    expect_round_trip(on_grid(many, 4), GetParam());
    IndexedMesh twins = octahedron();
    for (int i = 1; i < 12; ++i)
    {
        twins = joined(twins, octahedron(), 0.0);
    }
    expect_round_trip(on_grid(twins, 12), GetParam());
}

TEST_P(BaseMesh, IsCodedAlikeEveryTime)
{
    const GridMesh base = on_grid(torus(9, 7, 0.1, 2), 10);
    EXPECT_EQ(encode(base, GetParam())->bytes, encode(base, GetParam())->bytes);
}

TEST(SmallBase, TakesTheFewerBytesWhereItIsChosen)
{
    for (const IndexedMesh& shape : {tetrahedron(), strip(20), sphere(6, 7, 0.1, 1), fan(400)})
    {
        const GridMesh base = on_grid(shape, 6);
        const auto chosen = codec::encode_base_mesh(base, kExtent);
        ASSERT_TRUE(chosen.has_value());
        EXPECT_EQ(
            chosen->bytes.size(),
            std::min(encode(base, 0)->bytes.size(), encode(base, 1)->bytes.size())
        );
    }
    // Half of what Draco takes, as long as Draco's tables weigh.
    const GridMesh base = on_grid(sphere(6, 7, 0.1, 1), 6);
    EXPECT_LT(encode(base, 1)->bytes.size() * 3, encode(base, 0)->bytes.size() * 2);
}

TEST(SmallBase, RefusesWhatIsTooLargeForIt)
{
    const auto bytes = encode(on_grid(tetrahedron(), 12), 1)->bytes;
    EXPECT_TRUE(decode(bytes, 1, 4, 4).has_value());
    EXPECT_EQ(decode(bytes, 1, 4, 13).error().code, ErrorCode::BadChunk);
    EXPECT_EQ(decode(bytes, 1, 4097, 8190).error().code, ErrorCode::BadChunk);
    const GridMesh large = on_grid(torus(70, 60, 0.1, 2), 12);
    const auto chosen = codec::encode_base_mesh(large, kExtent);
    ASSERT_TRUE(chosen.has_value());
    EXPECT_EQ(chosen->codec, proto::kDracoBaseCodec);
}

class BaseMeshBytes : public ::testing::TestWithParam<int>
{
protected:
    void SetUp() override
    {
        base_ = on_grid(sphere(7, 8, 0.1, 1), 10);
        bytes_ = encode(base_, GetParam())->bytes;
    }

    [[nodiscard]] Result<GridMesh> decode_bytes(const std::vector<std::byte>& bytes) const
    {
        return decode(bytes, GetParam(), size_of(base_.positions), size_of(base_.triangles));
    }

    GridMesh base_;
    std::vector<std::byte> bytes_;
};

INSTANTIATE_TEST_SUITE_P(
    Codecs,
    BaseMeshBytes,
    ::testing::Values(int{proto::kDracoBaseCodec}, int{proto::kSmallBaseCodec})
);

TEST_P(BaseMeshBytes, AreRejectedWhenTruncated)
{
    for (std::size_t length = 0; length < bytes_.size(); ++length)
    {
        const auto decoded =
            decode_bytes({bytes_.begin(), bytes_.begin() + static_cast<long>(length)});
        ASSERT_FALSE(decoded.has_value()) << length;
        EXPECT_EQ(decoded.error().code, ErrorCode::BadChunk);
    }
}

TEST_P(BaseMeshBytes, AreRejectedWithTrailingBytes)
{
    bytes_.push_back(std::byte{0});
    EXPECT_EQ(decode_bytes(bytes_).error().code, ErrorCode::BadChunk);
}

TEST_P(BaseMeshBytes, AreRejectedWhenTheCountsDiffer)
{
    const std::uint32_t vertices = size_of(base_.positions);
    const std::uint32_t faces = size_of(base_.triangles);
    EXPECT_TRUE(decode(bytes_, GetParam(), vertices, faces).has_value());
    EXPECT_FALSE(decode(bytes_, GetParam(), vertices - 1, faces).has_value());
    EXPECT_FALSE(decode(bytes_, GetParam(), vertices + 1, faces).has_value());
    EXPECT_FALSE(decode(bytes_, GetParam(), vertices, faces - 1).has_value());
    EXPECT_FALSE(decode(bytes_, GetParam(), vertices, faces + 1).has_value());
}

TEST_P(BaseMeshBytes, NeverGiveOtherCountsWhenTheyAreChanged)
{
    std::mt19937 random(3);
    for (std::size_t i = 0; i < bytes_.size(); ++i)
    {
        for (int time = 0; time < 4; ++time)
        {
            auto changed = bytes_;
            changed[i] ^= static_cast<std::byte>(1U + random() % 255U);
            const auto decoded = decode_bytes(changed);
            if (decoded)
            {
                EXPECT_EQ(decoded->positions.size(), base_.positions.size());
                EXPECT_EQ(decoded->triangles.size(), base_.triangles.size());
            }
        }
    }
}

}  // namespace
}  // namespace vsplit::test
