#include "precompute/attribute_cost.h"

#include "codec/shapes.h"
#include "precompute/wedges.h"

#include <gtest/gtest.h>

#include <functional>

namespace vsplit::test {
namespace {

using precompute::AttributeCost;
using precompute::CollapseMesh;
using precompute::OneRing;
using precompute::Vector3;
using precompute::operator-;

using Value = std::function<std::vector<std::int32_t>(const Vector3&)>;

/// A flat fan with values at its vertices; its hub is where it is not the mean of the others.
struct Sheet
{
    Sheet(const codec::AttributeInfo& info, const Value& value)
        : shape(fan(6)), infos{info}, wedges(precompute::split_wedges(shape, {}, {}))
    {
        shape.positions[0][0] += 0.2;
        values.resize(1);
        for (const auto& [x, y, z] : shape.positions)
        {
            positions.push_back({100.0 * x, 100.0 * y, 0.0});
        }
        std::vector<std::vector<std::int32_t>> by_wedge(wedges.count);
        for (std::size_t f = 0; f < shape.triangles.size(); ++f)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                by_wedge[wedges.corners[f][k]] = value(positions[shape.triangles[f][k]]);
            }
        }
        for (const auto& numbers : by_wedge)
        {
            values[0].insert(values[0].end(), numbers.begin(), numbers.end());
        }
    }

    /// Price of folding the hub into its first neighbour.
    [[nodiscard]] double price(double weight) const
    {
        const CollapseMesh mesh(7, shape.triangles, wedges.corners);
        const AttributeCost cost(mesh, positions, {.attributes = infos, .values = values}, weight);
        OneRing ring;
        EXPECT_TRUE(mesh.ring(0, ring));
        std::vector<Vector3> offset;
        for (std::size_t i = 0; i < ring.size; ++i)
        {
            offset.push_back(positions[ring.vertex[i]] - positions[0]);
        }
        return cost.empty() ? -1.0 : cost.price(ring, offset, 0);
    }

    IndexedMesh shape;
    std::vector<codec::AttributeInfo> infos;
    precompute::Wedges wedges;
    std::vector<Vector3> positions;
    std::vector<std::vector<std::int32_t>> values;
};

std::int32_t rounded(double x)
{
    return static_cast<std::int32_t>(x + 10000.5) - 10000;
}

/// Texture coordinates that are the position, `scale` times as fine, and off by `slide` at the hub.
Value texture(double scale, double slide)
{
    return [=](const Vector3& p) {
        const bool is_hub = p[0] * p[0] + p[1] * p[1] < 2500.0;
        const double u = p[0] + (is_hub ? slide : 0.0);
        return std::vector<std::int32_t>{rounded(scale * u), rounded(scale * p[1])};
    };
}

const codec::AttributeInfo kTexture{
    .kind = AttributeKind::TexCoord, .components = 2, .bits = 16, .name = {}};
const codec::AttributeInfo kColor{
    .kind = AttributeKind::Color, .components = 3, .bits = 8, .name = {}, .cell = 1.0F / 255.0F};

TEST(AttributeCost, IsNothingWhereTheTextureFollowsTheSurface)
{
    EXPECT_LT(Sheet(kTexture, texture(100.0, 0.0)).price(1.0), 1.0);
}

TEST(AttributeCost, GrowsWithTheSquareOfTheSlide)
{
    const double small = Sheet(kTexture, texture(100.0, 4.0)).price(1.0);
    const double large = Sheet(kTexture, texture(100.0, 8.0)).price(1.0);
    EXPECT_GT(small, 1000.0);
    EXPECT_NEAR(large / small, 4.0, 0.2);
    EXPECT_NEAR(Sheet(kTexture, texture(100.0, 4.0)).price(0.5) / small, 0.25, 1e-9);
}

TEST(AttributeCost, IsTheSameForFinerTextures)
{
    const double coarse = Sheet(kTexture, texture(50.0, 4.0)).price(1.0);
    const double fine = Sheet(kTexture, texture(200.0, 4.0)).price(1.0);
    EXPECT_NEAR(coarse / fine, 1.0, 0.02);
}

TEST(AttributeCost, CountsColours)
{
    const auto grey = [](std::int32_t at_hub) {
        return [at_hub](const Vector3& p) {
            const bool is_hub = p[0] * p[0] + p[1] * p[1] < 2500.0;
            return std::vector<std::int32_t>{is_hub ? at_hub : 100, 0, 0};
        };
    };
    EXPECT_NEAR(Sheet(kColor, grey(100)).price(1.0), 0.0, 1e-6);
    const double small = Sheet(kColor, grey(120)).price(1.0);
    EXPECT_GT(small, 0.0);
    EXPECT_NEAR(Sheet(kColor, grey(140)).price(1.0) / small, 4.0, 1e-3);
}

TEST(AttributeCost, IsEmptyWithoutWeightOrWithoutWhatIsSeen)
{
    EXPECT_EQ(Sheet(kTexture, texture(100.0, 4.0)).price(0.0), -1.0);
    const codec::AttributeInfo scalar{
        .kind = AttributeKind::Scalar, .components = 2, .bits = 16, .name = {}};
    EXPECT_EQ(Sheet(scalar, texture(100.0, 4.0)).price(1.0), -1.0);
    // A texture that is one point cannot slide.
    const auto constant = [](const Vector3&) { return std::vector<std::int32_t>{3, 3}; };
    EXPECT_EQ(Sheet(kTexture, constant).price(1.0), -1.0);
}

}  // namespace
}  // namespace vsplit::test
