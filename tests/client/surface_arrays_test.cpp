#include "surface_arrays.h"

#include "painted_cube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vsplit::client {
namespace {

using Position = std::array<float, 3>;

// What a level of a decoder looks like: a strip of quads with random seams, groups and values.
struct Level
{
    std::vector<Position> positions;
    std::vector<Triangle> triangles;
    std::vector<codec::AttributeInfo> infos;
    codec::LevelAttributes attributes;

    SurfaceInput input(const Appearance* appearance = nullptr) const
    {
        return {positions, triangles, infos, &attributes, appearance};
    }
};

codec::AttributeInfo info_of(AttributeKind kind, std::uint8_t set, std::uint8_t components)
{
    codec::AttributeInfo info;
    info.kind = kind;
    info.set = set;
    info.components = components;
    info.bits = 8;
    info.cell = 1.0F / 255.0F;
    return info;
}

void add_wedges(Level& level, std::mt19937& random)
{
    std::vector<std::vector<std::uint32_t>> wedges_of(level.positions.size());
    for (const Triangle& triangle : level.triangles)
    {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            auto& known = wedges_of[triangle[k]];
            if (known.empty() || random() % 4 == 0)
            {
                known.push_back(static_cast<std::uint32_t>(level.attributes.wedge_vertices.size()));
                level.attributes.wedge_vertices.push_back(triangle[k]);
            }
            corners[k] = known[random() % known.size()];
        }
        level.attributes.wedges.push_back(corners);
        level.attributes.groups.push_back(static_cast<std::uint32_t>(random() % 5));
    }
}

Level random_level(unsigned seed)
{
    std::mt19937 random(seed);
    Level level;
    constexpr std::uint32_t kSide = 12;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    {
        level.positions.push_back(
            {static_cast<float>(i % kSide),
             static_cast<float>(i / kSide),
             static_cast<float>(random() % 100) / 100.0F}
        );
    }
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
    {
        for (std::uint32_t x = 0; x + 1 < kSide; ++x)
        {
            const std::uint32_t a = y * kSide + x;
            level.triangles.push_back({a, a + 1, a + kSide});
            level.triangles.push_back({a + 1, a + kSide + 1, a + kSide});
        }
    }
    add_wedges(level, random);
    level.infos = {
        info_of(AttributeKind::TexCoord, 0, 2),
        info_of(AttributeKind::TexCoord, 1, 2),
        info_of(AttributeKind::Color, 0, 4)};
    level.infos.back().rgb = true;
    for (const codec::AttributeInfo& info : level.infos)
    {
        std::vector<std::int32_t> values;
        for (std::size_t i = 0; i < level.attributes.wedge_vertices.size() * info.components; ++i)
        {
            values.push_back(static_cast<std::int32_t>(random() % 256));
        }
        level.attributes.values.push_back(values);
    }
    return level;
}

Appearance five_groups()
{
    Appearance appearance;
    appearance.materials.resize(3);
    appearance.materials[2].alpha_mode = AlphaMode::Blend;
    appearance.groups = {{"a", 1}, {"b", 2}, {"c", 0}, {"d", 2}, {"e", 1}};
    return appearance;
}

TEST(SurfaceArrays, HaveAVertexPerWedgeWithItsPositionAndValues)
{
    for (const unsigned seed : {1U, 2U, 3U})
    {
        SCOPED_TRACE(seed);
        const Level level = random_level(seed);
        const SurfaceArrays arrays = make_surface_arrays(level.input());
        const std::size_t count = level.attributes.wedge_vertices.size();
        ASSERT_EQ(arrays.positions.size(), count);
        ASSERT_EQ(arrays.normals.size(), count);
        ASSERT_EQ(arrays.colors.size(), count);
        ASSERT_EQ(arrays.tex_coords[0].size(), count);
        ASSERT_EQ(arrays.tex_coords[1].size(), count);
        for (std::size_t w = 0; w < count; ++w)
        {
            ASSERT_EQ(arrays.positions[w], level.positions[level.attributes.wedge_vertices[w]]);
            for (std::size_t k = 0; k < 2; ++k)
            {
                ASSERT_NEAR(
                    arrays.tex_coords[1][w][k] * 255.0F, level.attributes.values[1][2 * w + k], 0.01
                );
            }
            for (std::size_t k = 0; k < 4; ++k)
            {
                ASSERT_EQ(arrays.colors[w][k], level.attributes.values[2][4 * w + k]);
            }
        }
        ASSERT_EQ(arrays.triangles, level.attributes.wedges) << "one range keeps the order";
        ASSERT_EQ(arrays.ranges.size(), 1U);
        EXPECT_EQ(arrays.ranges[0].count, level.triangles.size());
        EXPECT_FALSE(arrays.authored_normals);
    }
}

TEST(SurfaceArrays, RangesAreThoseOfASortByMaterial)
{
    const Level level = random_level(7);
    const Appearance appearance = five_groups();
    const SurfaceArrays arrays = make_surface_arrays(level.input(&appearance));
    // Materials 0 and 1, which hide, then groups 1 and 3, which one sees through.
    std::vector<Triangle> expected;
    std::vector<std::uint32_t> counts;
    for (const std::vector<std::uint32_t>& groups :
         std::vector<std::vector<std::uint32_t>>{{2}, {0, 4}, {1}, {3}})
    {
        const std::size_t before = expected.size();
        for (std::size_t t = 0; t < level.triangles.size(); ++t)
        {
            if (std::ranges::count(groups, level.attributes.groups[t]) > 0)
            {
                expected.push_back(level.attributes.wedges[t]);
            }
        }
        counts.push_back(static_cast<std::uint32_t>(expected.size() - before));
    }
    EXPECT_EQ(arrays.triangles, expected);
    ASSERT_EQ(arrays.ranges.size(), 4U);
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        EXPECT_EQ(arrays.ranges[i].material, (std::array{0, 1, 2, 2}[i]));
        EXPECT_EQ(arrays.ranges[i].first, first);
        EXPECT_EQ(arrays.ranges[i].count, counts[i]);
        first += counts[i];
    }
}

TEST(SurfaceArrays, TakeGroupsAndMaterialsThatDoNotExistForNone)
{
    Level level = random_level(9);
    std::ranges::fill(level.attributes.groups, 4000000000U);
    level.attributes.groups[0] = 0;
    Appearance appearance = five_groups();
    appearance.groups[0].material = 17;
    const SurfaceArrays arrays = make_surface_arrays(level.input(&appearance));
    ASSERT_EQ(arrays.ranges.size(), 1U);
    EXPECT_EQ(arrays.ranges[0].material, -1);
    EXPECT_EQ(arrays.ranges[0].count, level.triangles.size());
}

TEST(SurfaceArrays, WithoutAttributesHaveAVertexPerVertex)
{
    const Level level = random_level(4);
    SurfaceInput input;
    input.positions = level.positions;
    input.triangles = level.triangles;
    const SurfaceArrays arrays = make_surface_arrays(input);
    EXPECT_EQ(arrays.positions, level.positions);
    EXPECT_EQ(arrays.triangles, level.triangles);
    EXPECT_TRUE(arrays.colors.empty());
    EXPECT_TRUE(arrays.tex_coords[0].empty());
}

float length_of(const std::array<std::int16_t, 4>& normal)
{
    const Position n{
        static_cast<float>(normal[0]),
        static_cast<float>(normal[1]),
        static_cast<float>(normal[2])};
    return std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 32767.0F;
}

TEST(SurfaceArrays, ShareTheDerivedNormalAcrossASeamOfTheTexture)
{
    const Level level = random_level(5);
    const SurfaceArrays arrays = make_surface_arrays(level.input());
    std::vector<std::array<std::int16_t, 4>> by_vertex(level.positions.size());
    for (std::size_t w = 0; w < arrays.normals.size(); ++w)
    {
        auto& known = by_vertex[level.attributes.wedge_vertices[w]];
        if (known[3] != 0)
        {
            EXPECT_EQ(known, arrays.normals[w]);
        }
        known = arrays.normals[w];
        EXPECT_LE(length_of(known), 1.001F);
    }
}

// The cube as a decoder gives it before its normals came: a wedge per side and corner.
TEST(SurfaceArrays, KeepHardEdgesHardBeforeTheAuthorsNormalsCome)
{
    const Surface cube = cube_surface();
    Level level;
    for (const auto& p : cube.mesh.positions)
    {
        level.positions.push_back(
            {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}
        );
    }
    level.triangles = cube.mesh.triangles;
    for (std::uint32_t t = 0; t < 12; ++t)
    {
        // The second triangle of a side uses the first one's wedges where they meet.
        const std::uint32_t first = 4 * (t / 2);
        level.attributes.wedges.push_back(
            t % 2 == 0 ? Triangle{first, first + 1, first + 2}
                       : Triangle{first + 2, first + 1, first + 3}
        );
        const Triangle& vertices = cube.mesh.triangles[t];
        if (t % 2 == 0)
        {
            auto& list = level.attributes.wedge_vertices;
            list.insert(list.end(), vertices.begin(), vertices.end());
        }
        else
        {
            level.attributes.wedge_vertices.push_back(vertices[2]);
        }
    }
    level.infos = {info_of(AttributeKind::Normal, 0, 3)};
    level.attributes.values.resize(1);
    const SurfaceArrays arrays = make_surface_arrays(level.input());
    ASSERT_EQ(arrays.normals.size(), 24U);
    for (std::uint32_t wedge = 0; wedge < 24; ++wedge)
    {
        const std::uint32_t side = wedge / 4;
        std::array<std::int16_t, 4> expected{0, 0, 0, 32767};
        expected[side / 2] = side % 2 == 0 ? 32767 : -32767;
        for (std::size_t k = 0; k < 4; ++k)
        {
            EXPECT_NEAR(arrays.normals[wedge][k], expected[k], 4);
        }
    }
    EXPECT_FALSE(arrays.authored_normals);

    // Once they are there they are used, whatever the triangles say.
    level.attributes.values[0].assign(48, 127);
    const SurfaceArrays authored = make_surface_arrays(level.input());
    EXPECT_TRUE(authored.authored_normals);
    EXPECT_NEAR(authored.normals[0][2], 32767, 1);
    EXPECT_NEAR(authored.normals[20][2], 32767, 1);
}

TEST(SurfaceArrays, OfASurfaceHaveAVertexPerDifferentCorner)
{
    const Surface cube = cube_surface();
    const SurfaceArrays arrays = make_surface_arrays(cube);
    // At a corner of the cube three sides meet; the texture coordinates of some agree.
    EXPECT_GT(arrays.positions.size(), 8U);
    EXPECT_LE(arrays.positions.size(), 24U);
    ASSERT_EQ(arrays.triangles.size(), 12U);
    for (std::size_t t = 0; t < 12; ++t)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::uint32_t wedge = arrays.triangles[t][k];
            const auto& p = cube.mesh.positions[cube.mesh.triangles[t][k]];
            EXPECT_EQ(
                arrays.positions[wedge],
                (Position{
                    static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])})
            );
            const std::uint32_t value = cube.attributes[0].corners[t][k];
            EXPECT_EQ(arrays.tex_coords[0][wedge][0], cube.attributes[0].values[2 * value]);
            EXPECT_EQ(arrays.tex_coords[0][wedge][1], cube.attributes[0].values[2 * value + 1]);
        }
    }
}

TEST(SurfaceArrays, MemoryThatIsPlannedCoversThem)
{
    const Level level = random_level(11);
    const SurfaceArrays arrays = make_surface_arrays(level.input());
    // Twice: here and on the GPU. The seams of this level are far more than the plan assumes.
    const std::uint64_t vertices = level.attributes.wedge_vertices.size() * 2 / 3 + 1;
    EXPECT_LE(
        2 * arrays.bytes(),
        surface_memory_bytes(vertices, level.triangles.size(), level.infos, false)
    );
}

}  // namespace
}  // namespace vsplit::client
