#include "codec/stitch_coder.h"

#include "codec/entropy_coder.h"
#include "core/byte_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace vsplit::test {
namespace {

using codec::BitDecoder;
using codec::BitEncoder;
using Position = std::array<std::int32_t, 3>;

std::vector<std::byte> encode(
    const std::vector<Position>& positions, std::vector<std::uint32_t> stitches
)
{
    BitEncoder bits;
    const auto position = [&](std::uint32_t v) { return positions[v]; };
    codec::code_stitches(bits, position, stitches);
    ByteWriter out;
    bits.finish(out);
    return out.take();
}

Result<std::vector<std::uint32_t>> decode(
    const std::vector<Position>& positions, std::span<const std::byte> bytes
)
{
    BitDecoder bits;
    VSPLIT_TRY(bits.start(bytes));
    std::vector<std::uint32_t> stitches(positions.size(), 0);
    const auto position = [&](std::uint32_t v) { return positions[v]; };
    codec::code_stitches(bits, position, stitches);
    VSPLIT_TRY(bits.finish());
    return stitches;
}

void expect_round_trip(
    const std::vector<Position>& positions, const std::vector<std::uint32_t>& stitches
)
{
    const auto bytes = encode(positions, stitches);
    const auto decoded = decode(positions, bytes);
    ASSERT_TRUE(decoded.has_value()) << describe(decoded.error());
    EXPECT_EQ(*decoded, stitches);
}

TEST(Stitches, ComeBack)
{
    const Position a{1, 2, 3};
    const Position b{4, 5, 6};
    const Position c{1, 2, 4};
    expect_round_trip({}, {});
    expect_round_trip({a}, {0});
    expect_round_trip({a, b, c}, {0, 1, 2});
    expect_round_trip({a, a, b, b, c}, {0, 0, 2, 2, 4});
    expect_round_trip({a, b, a, b, a}, {0, 1, 0, 1, 0});
    expect_round_trip({a, a, a, a}, {0, 1, 0, 1});
    expect_round_trip({a, a, a, a, a}, {0, 1, 2, 3, 4});
    expect_round_trip({a, a, a, a, b, b}, {0, 1, 1, 0, 4, 5});
}

/// Random positions on a small grid, and random classes within those at one position.
struct RandomStitches
{
    std::vector<Position> positions;
    std::vector<std::uint32_t> stitches;

    RandomStitches(unsigned seed, std::size_t count)
    {
        std::mt19937 random(seed);
        const auto grid = static_cast<unsigned>(1 + random() % 5);
        for (std::uint32_t v = 0; v < count; ++v)
        {
            positions.push_back({
                static_cast<std::int32_t>(random() % grid),
                static_cast<std::int32_t>(random() % grid),
                static_cast<std::int32_t>(random() % grid),
            });
            stitches.push_back(v);
            const std::uint32_t other = static_cast<std::uint32_t>(random() % (v + 1));
            if (positions[other] == positions[v])
            {
                stitches[v] = stitches[other];
            }
        }
    }
};

TEST(Stitches, ComeBackWhateverTheClasses)
{
    for (unsigned seed = 0; seed < 300; ++seed)
    {
        SCOPED_TRACE(seed);
        const RandomStitches sample(seed, 1 + seed);
        expect_round_trip(sample.positions, sample.stitches);
    }
}

TEST(Stitches, AreRejectedWhenTruncated)
{
    const RandomStitches sample(5, 300);
    const auto bytes = encode(sample.positions, sample.stitches);
    ASSERT_GT(bytes.size(), 5U);
    for (std::size_t length = 0; length < bytes.size(); ++length)
    {
        EXPECT_FALSE(decode(sample.positions, std::span(bytes).first(length)).has_value());
    }
}

TEST(Stitches, JoinOnlyVerticesAtOnePositionWhateverTheBytes)
{
    const RandomStitches sample(7, 300);
    const auto& positions = sample.positions;
    const auto bytes = encode(positions, sample.stitches);
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        for (unsigned change = 1; change < 256; change += 6)
        {
            auto changed = bytes;
            changed[i] ^= static_cast<std::byte>(change);
            const auto decoded = decode(positions, changed);
            for (std::uint32_t v = 0; decoded && v < positions.size(); ++v)
            {
                ASSERT_LE((*decoded)[v], v);
                ASSERT_EQ(positions[(*decoded)[v]], positions[v]);
                ASSERT_EQ((*decoded)[(*decoded)[v]], (*decoded)[v]);
            }
        }
    }
}

TEST(GroupByPosition, PutsEqualPositionsTogetherLowestFirst)
{
    const std::vector<Position> positions{{2, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 0, 1}};
    EXPECT_THAT(
        codec::group_by_position(5, [&](std::uint32_t v) { return positions[v]; }),
        ::testing::ElementsAre(1, 3, 4, 0, 2)
    );
}

}  // namespace
}  // namespace vsplit::test
