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

using codec::decode_base_mesh;
using codec::encode_base_mesh;

constexpr std::uint32_t kMost = 4095;

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

/// Codes a mesh and checks that the decoder gets it, renumbered as the encoder says.
void expect_round_trip(const GridMesh& base)
{
    const auto encoded = encode_base_mesh(base);
    ASSERT_TRUE(encoded.has_value()) << describe(encoded.error());
    const auto decoded =
        decode_base_mesh(encoded->bytes, size_of(base.positions), size_of(base.triangles), kMost);
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

TEST(BaseMesh, ComesBack)
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
        expect_round_trip(on_grid(shape, 12));
    }
}

TEST(BaseMesh, ComesBackFromAGridOnWhichVerticesCoincide)
{
    for (const int bits : {0, 1, 2, 3})
    {
        SCOPED_TRACE(bits);
        expect_round_trip(on_grid(tetrahedron(), bits));
        expect_round_trip(on_grid(double_cone(30), bits));
        expect_round_trip(on_grid(sphere(9, 10, 0.1, 1), bits));
        expect_round_trip(on_grid(torus(9, 7, 0.1, 2), bits));
        expect_round_trip(on_grid(height_field(9, 8, 0.5, 3), bits));
    }
}

TEST(BaseMesh, ComesBackInSeveralComponents)
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
    expect_round_trip(on_grid(many, 12));
    expect_round_trip(on_grid(many, 4));
    IndexedMesh twins = octahedron();
    for (int i = 1; i < 12; ++i)
    {
        twins = joined(twins, octahedron(), 0.0);
    }
    expect_round_trip(on_grid(twins, 12));
}

TEST(BaseMesh, IsCodedAlikeEveryTime)
{
    const GridMesh base = on_grid(torus(9, 7, 0.1, 2), 10);
    EXPECT_EQ(encode_base_mesh(base)->bytes, encode_base_mesh(base)->bytes);
}

class BaseMeshBytes : public ::testing::Test
{
protected:
    void SetUp() override
    {
        base_ = on_grid(sphere(7, 8, 0.1, 1), 10);
        bytes_ = encode_base_mesh(base_)->bytes;
    }

    [[nodiscard]] Result<GridMesh> decode(const std::vector<std::byte>& bytes) const
    {
        return decode_base_mesh(bytes, size_of(base_.positions), size_of(base_.triangles), kMost);
    }

    GridMesh base_;
    std::vector<std::byte> bytes_;
};

TEST_F(BaseMeshBytes, AreRejectedWhenTruncated)
{
    for (std::size_t length = 0; length < bytes_.size(); ++length)
    {
        const auto decoded = decode({bytes_.begin(), bytes_.begin() + static_cast<long>(length)});
        ASSERT_FALSE(decoded.has_value()) << length;
        EXPECT_EQ(decoded.error().code, ErrorCode::BadChunk);
    }
}

TEST_F(BaseMeshBytes, AreRejectedWithTrailingBytes)
{
    bytes_.push_back(std::byte{0});
    EXPECT_EQ(decode(bytes_).error().code, ErrorCode::BadChunk);
}

TEST_F(BaseMeshBytes, AreRejectedWhenTheCountsDiffer)
{
    const std::uint32_t vertices = size_of(base_.positions);
    const std::uint32_t faces = size_of(base_.triangles);
    EXPECT_TRUE(decode_base_mesh(bytes_, vertices, faces, kMost).has_value());
    EXPECT_FALSE(decode_base_mesh(bytes_, vertices - 1, faces, kMost).has_value());
    EXPECT_FALSE(decode_base_mesh(bytes_, vertices + 1, faces, kMost).has_value());
    EXPECT_FALSE(decode_base_mesh(bytes_, vertices, faces - 1, kMost).has_value());
    EXPECT_FALSE(decode_base_mesh(bytes_, vertices, faces + 1, kMost).has_value());
}

TEST_F(BaseMeshBytes, NeverGiveOtherCountsWhenTheyAreChanged)
{
    std::mt19937 random(3);
    for (std::size_t i = 0; i < bytes_.size(); ++i)
    {
        for (int time = 0; time < 4; ++time)
        {
            auto changed = bytes_;
            changed[i] ^= static_cast<std::byte>(1U + random() % 255U);
            const auto decoded = decode(changed);
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
