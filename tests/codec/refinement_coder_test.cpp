#include "codec/refinement_coder.h"

#include "codec/batch_coder.h"
#include "codec/entropy_coder.h"
#include "core/byte_writer.h"
#include "format.h"

#include <gtest/gtest.h>

#include <vector>

namespace vsplit::test {
namespace {

using codec::BatchState;
using codec::BitDecoder;
using codec::BitEncoder;
using Cells = std::vector<std::array<std::int32_t, 3>>;

/// A tetrahedron on a grid of 10 bits that lacks 3 of them.
BatchState tetrahedron()
{
    BatchState state;
    state.bits = 10;
    state.shift = 3;
    state.mesh.reserve(4, 4);
    const GridMesh base{
        .positions = {{10, 20, 30}, {100, 20, 30}, {10, 120, 30}, {0, 127, 127}},
        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
    };
    EXPECT_TRUE(state.mesh.set_base(base, state.max_index()).has_value());
    return state;
}

Cells positions_of(const BatchState& state)
{
    Cells cells;
    for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
    {
        const codec::Point& p = state.mesh.points()[v];
        cells.push_back(
            {static_cast<std::int32_t>(p.x),
             static_cast<std::int32_t>(p.y),
             static_cast<std::int32_t>(p.z)}
        );
    }
    return cells;
}

/// Starts a level, all in one.
template <typename Coder>
Result<void> code_level_start(Coder& coder, BatchState& state, int shift, const Cells& target)
{
    codec::start_level(coder, state, shift, target);
    return codec::is_refining(state) ? codec::refine_positions(coder, state, target)
                                     : Result<void>{};
}

Result<Cells> code_and_decode(const Cells& target, int shift, BatchState encoder = tetrahedron())
{
    BitEncoder bits;
    VSPLIT_TRY(code_level_start(bits, encoder, shift, target));
    EXPECT_EQ(positions_of(encoder), target);
    ByteWriter bytes;
    bits.finish(bytes);
    BatchState decoder = tetrahedron();
    BitDecoder read;
    VSPLIT_TRY(read.start(bytes.view()));
    VSPLIT_TRY(code_level_start(read, decoder, shift, {}));
    VSPLIT_TRY(read.finish());
    return positions_of(decoder);
}

TEST(Refinement, KeepsVerticesInTheirCells)
{
    const Cells target{{21, 40, 61}, {200, 41, 60}, {20, 241, 61}, {1, 254, 255}};
    EXPECT_EQ(code_and_decode(target, 2).value(), target);
}

TEST(Refinement, CarriesVerticesOutOfTheirCells)
{
    const Cells target{{19, 42, 61}, {203, 36, 60}, {20, 241, 61}, {5, 254, 250}};
    EXPECT_EQ(code_and_decode(target, 2).value(), target);
}

TEST(Refinement, GainsSeveralBitsAtOnce)
{
    const Cells target{{79, 170, 247}, {811, 143, 240}, {88, 967, 255}, {0, 1023, 1003}};
    EXPECT_EQ(code_and_decode(target, 0).value(), target);
}

TEST(Refinement, RefusesToCarryTooFar)
{
    Cells target{{21, 40, 61}, {200, 41, 60}, {20, 241, 61}, {1, 254, 255}};
    target[1][0] += codec::kMostCellsLeft + 2;
    const auto done = code_and_decode(target, 2);
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, ErrorCode::Internal);
}

TEST(Refinement, RefusesVerticesThatLeaveTheGrid)
{
    // What an encoder with a finer grid would write is too much for a decoder with this one.
    BatchState encoder = tetrahedron();
    encoder.bits = 11;
    Cells target{{21, 40, 61}, {200, 41, 60}, {20, 241, 61}, {1, 254, 255}};
    target[3][2] = 256;
    const auto done = code_and_decode(target, 2, std::move(encoder));
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, ErrorCode::BadChunk);
}

TEST(Refinement, CostsLittleForVerticesThatStay)
{
    codec::RefinementModel model;
    BitEncoder bits;
    for (int i = 0; i < 3000; ++i)
    {
        std::size_t left = 0;
        EXPECT_EQ(code_step(bits, model, i % 2, 1, left), i % 2);
        EXPECT_EQ(left, 0U);
    }
    ByteWriter bytes;
    bits.finish(bytes);
    EXPECT_LT(bytes.size(), 3000U / 8 + 30);
}

/// A fan of so many vertices on a grid of 20 bits that lacks 9 of them.
BatchState large_fan(std::uint32_t vertices)
{
    BatchState state;
    state.bits = 20;
    state.shift = 9;
    state.mesh.reserve(vertices, vertices - 2);
    GridMesh base;
    for (std::uint32_t v = 0; v < vertices; ++v)
    {
        const auto x = static_cast<std::int32_t>(v);
        base.positions.push_back({x % 2048, x / 2048, x % 1999});
        if (v >= 2)
        {
            base.triangles.push_back({0, v - 1, v});
        }
    }
    EXPECT_TRUE(state.mesh.set_base(base, state.max_index()).has_value());
    return state;
}

TEST(Refinement, IsCutIntoChunksThatAreNotTooLong)
{
    for (const int steps : {1, 2, 9})
    {
        SCOPED_TRACE(steps);
        const std::uint32_t vertices = 3 * codec::refined_per_chunk(steps) + 5;
        BatchState encoder = large_fan(vertices);
        BatchState decoder = large_fan(vertices);
        Cells target = positions_of(encoder);
        for (std::size_t v = 0; v < target.size(); ++v)
        {
            for (std::int32_t& x : target[v])
            {
                x = x << steps | static_cast<std::int32_t>(v * 7 % (1U << steps));
            }
        }
        int chunks = 0;
        for (bool more = true; more; more = codec::is_refining(encoder), ++chunks)
        {
            BitEncoder bits;
            BitDecoder read;
            if (chunks == 0)
            {
                codec::start_level(bits, encoder, 9 - steps, target);
            }
            ASSERT_TRUE(codec::refine_positions(bits, encoder, target).has_value());
            ByteWriter bytes;
            bits.finish(bytes);
            EXPECT_LT(bytes.size(), proto::kTargetChunkBytes * 3 / 4);
            ASSERT_TRUE(read.start(bytes.view()).has_value());
            if (chunks == 0)
            {
                codec::start_level(read, decoder, 9 - steps, {});
            }
            ASSERT_TRUE(codec::refine_positions(read, decoder, {}).has_value());
            ASSERT_TRUE(read.finish().has_value());
            // Those to come are shown in the middle of their cells.
            const Cells shown = positions_of(decoder);
            EXPECT_EQ(shown, positions_of(encoder));
            EXPECT_NEAR(shown.back()[0], target.back()[0], more ? 1 << (steps - 1) : 0);
        }
        EXPECT_EQ(chunks, 4);
        EXPECT_EQ(positions_of(decoder), target);
    }
}

}  // namespace
}  // namespace vsplit::test
