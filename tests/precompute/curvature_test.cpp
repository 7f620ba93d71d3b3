#include "precompute/curvature.h"

#include "precompute/curvature_shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

namespace vsplit::precompute {
namespace {

using test::link;
using test::make_sphere;
using test::moved;
using test::sample_parametric;

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Estimator
{
    const char* name;
    std::vector<float> (*estimate)(const HalfEdgeMesh&, unsigned);
};

std::ostream& operator<<(std::ostream& out, const Estimator& estimator)
{
    return out << estimator.name;
}

class CurvatureEstimator : public testing::TestWithParam<Estimator>
{
protected:
    static std::vector<float> estimate(const IndexedMesh& mesh, unsigned threads = 1)
    {
        return GetParam().estimate(link(mesh), threads);
    }

    // Fails unless the values at the vertices that `wanted` selects are within `tolerance`
    // (relative) of `expected(position)`.
    template <typename Expected, typename Wanted>
    static void expect_curvature(
        const IndexedMesh& mesh, double tolerance, const Expected& expected, const Wanted& wanted
    )
    {
        const std::vector<float> curvature = estimate(mesh);
        ASSERT_EQ(curvature.size(), mesh.positions.size());
        double worst = 0.0;
        std::size_t compared = 0;
        for (std::size_t v = 0; v < curvature.size(); ++v)
        {
            if (wanted(mesh.positions[v]))
            {
                const double truth = expected(mesh.positions[v]);
                worst = std::max(worst, std::abs(static_cast<double>(curvature[v]) / truth - 1.0));
                ++compared;
            }
        }
        EXPECT_GT(compared, curvature.size() / 2);
        EXPECT_LT(worst, tolerance);
    }

    template <typename Expected>
    static void expect_curvature(
        const IndexedMesh& mesh, double tolerance, const Expected& expected
    )
    {
        expect_curvature(mesh, tolerance, expected, [](const auto&) { return true; });
    }
};

INSTANTIATE_TEST_SUITE_P(
    Both,
    CurvatureEstimator,
    testing::Values(
        Estimator{"Quadric", quadric_curvature}, Estimator{"Bspline", bspline_curvature}
    ),
    [](const auto& parameter) { return std::string(parameter.param.name); }
);

IndexedMesh make_torus(double ring, double tube, std::uint32_t cells, double jitter)
{
    return sample_parametric(
        [=](double u, double v) {
            const double out = ring + tube * std::cos(kTurn * v);
            return std::array{
                out * std::cos(kTurn * u), out * std::sin(kTurn * u), tube * std::sin(kTurn * v)};
        },
        3 * cells,
        cells,
        {.u = true, .v = true},
        jitter
    );
}

TEST_P(CurvatureEstimator, FindsTwoOverTheRadiusOnASphere)
{
    expect_curvature(make_sphere(2.5, 4), 0.02, [](const auto&) { return 2.0 / 2.5; });
}

TEST_P(CurvatureEstimator, FindsOneOverTheRadiusOnACylinder)
{
    const IndexedMesh cylinder = sample_parametric(
        [](double u, double v) {
            return std::array{0.5 * std::cos(kTurn * u), 0.5 * std::sin(kTurn * u), 3.0 * v};
        },
        60,
        60,
        {.u = true},
        0.25
    );
    // The two rims see one side only.
    expect_curvature(
        cylinder,
        0.05,
        [](const auto&) { return 1.0 / 0.5; },
        [](const auto& p) { return p[2] > 0.3 && p[2] < 2.7; }
    );
}

TEST_P(CurvatureEstimator, FollowsTheClosedFormAlongTheTubeOfATorus)
{
    const double ring = 2.0, tube = 0.8;
    expect_curvature(make_torus(ring, tube, 60, 0.2), 0.03, [=](const auto& p) {
        const double out = std::hypot(p[0], p[1]);
        return 1.0 / tube + std::abs((out - ring) / tube) / out;
    });
}

TEST_P(CurvatureEstimator, AddsTheMagnitudesOfOppositeCurvaturesOnASaddle)
{
    const std::uint32_t cells = 40;
    const IndexedMesh saddle = sample_parametric(
        [](double u, double v) {
            const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
            return std::array{x, y, x * x - y * y};
        },
        cells,
        cells
    );
    const std::size_t origin = (cells / 2) * (cells + 1) + cells / 2;
    ASSERT_EQ(saddle.positions[origin], (std::array{0.0, 0.0, 0.0}));
    // k1 = 2, k2 = -2: the mean curvature is 0, the absolute one 4.
    EXPECT_NEAR(static_cast<double>(estimate(saddle)[origin]), 4.0, 0.02);
}

TEST_P(CurvatureEstimator, IsZeroOnAPlane)
{
    const IndexedMesh plane = sample_parametric(
        [](double u, double v) {
            return std::array{u, v, 0.5 * u - 0.25 * v};
        },
        20,
        20,
        {},
        0.3
    );
    EXPECT_THAT(estimate(plane), testing::Each(0.0F));
}

TEST_P(CurvatureEstimator, DoesNotChangeWhenTheModelIsMoved)
{
    const IndexedMesh torus = make_torus(2.0, 0.7, 24, 0.3);
    const auto still = estimate(torus);
    const auto turned = estimate(moved(torus, 1.0, {10.0, -20.0, 5.0}));
    for (std::size_t v = 0; v < still.size(); ++v)
    {
        ASSERT_NEAR(turned[v] / still[v], 1.0F, 1e-4F) << "vertex " << v;
    }
}

TEST_P(CurvatureEstimator, ShrinksInProportionWhenTheModelGrows)
{
    const IndexedMesh torus = make_torus(2.0, 0.7, 24, 0.3);
    const auto small = estimate(torus);
    for (const double scale : {1e-6, 37.0, 1e9})
    {
        const auto large = estimate(moved(torus, scale, {0.0, 0.0, 0.0}));
        for (std::size_t v = 0; v < small.size(); ++v)
        {
            const double product = static_cast<double>(large[v]) * scale;
            ASSERT_NEAR(product / static_cast<double>(small[v]), 1.0, 1e-4) << "vertex " << v;
        }
    }
}

TEST_P(CurvatureEstimator, DoesNotDependOnTheNumberOfThreads)
{
    const IndexedMesh torus = make_torus(2.0, 0.7, 60, 0.3);
    const auto one = estimate(torus, 1);
    EXPECT_EQ(one, estimate(torus, 2));
    EXPECT_EQ(one, estimate(torus, 5));
}

TEST_P(CurvatureEstimator, StaysFiniteOnDegenerateInput)
{
    const double huge = std::numeric_limits<double>::max();
    const std::vector<IndexedMesh> meshes{
        {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}},
        {.positions = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, .triangles = {{0, 1, 2}}},
        {.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}},
        {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}, {0, 2, 1}}},
        {.positions = {{0, 0, 0}, {huge, 0, 0}, {0, -huge, 0}}, .triangles = {{0, 1, 2}}},
        {.positions = {{0, 0, 0}, {1e-300, 0, 0}, {0, 1e-300, 0}, {0, 0, 1e-300}},
         .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}},
    };
    for (std::size_t i = 0; i < meshes.size(); ++i)
    {
        const auto curvature = estimate(meshes[i]);
        ASSERT_EQ(curvature.size(), meshes[i].positions.size());
        for (const float value : curvature)
        {
            EXPECT_TRUE(std::isfinite(value) && value >= 0.0F) << "mesh " << i << ": " << value;
        }
        for (const float weight : sparseness_weights(link(meshes[i])))
        {
            EXPECT_TRUE(std::isfinite(weight) && weight > 0.0F) << "mesh " << i << ": " << weight;
        }
    }
}

TEST(BsplineCurvature, IsLessBiasedThanTheQuadricFitByAFourthOrderTerm)
{
    // x^2 y^2 is out of a quadric's reach, but not out of a bicubic patch's. At the origin k1 = k2 = 2.
    const std::uint32_t cells = 30;
    const IndexedMesh sheet = sample_parametric(
        [](double u, double v) {
            const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
            return std::array{x, y, x * x + y * y + 60.0 * x * x * y * y};
        },
        cells,
        cells
    );
    const std::size_t origin = (cells / 2) * (cells + 1) + cells / 2;
    const HalfEdgeMesh linked = link(sheet);
    const double quadric_error = std::abs(quadric_curvature(linked)[origin] - 4.0F);
    const double bspline_error = std::abs(bspline_curvature(linked)[origin] - 4.0F);
    EXPECT_LT(bspline_error, 0.75 * quadric_error);
}

// A plane with one smooth bump in its middle: flat beyond `reach` of the centre.
IndexedMesh make_bump(std::uint32_t cells, double reach)
{
    return sample_parametric(
        [reach](double u, double v) {
            const double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
            const double inside = std::max(0.0, 1.0 - (x * x + y * y) / (reach * reach));
            return std::array{x, y, 0.3 * inside * inside * inside};
        },
        cells,
        cells
    );
}

TEST(FeaturePoints, LieOnABumpAndNotOnThePlaneAroundIt)
{
    const std::uint32_t cells = 60;
    const IndexedMesh bump = make_bump(cells, 0.4);
    const auto features = feature_points(link(bump), quadric_curvature(link(bump)));
    ASSERT_EQ(features.size(), bump.positions.size());
    EXPECT_EQ(features[(cells / 2) * (cells + 1) + cells / 2], 1) << "the top";
    for (std::size_t v = 0; v < features.size(); ++v)
    {
        const auto& p = bump.positions[v];
        if (std::hypot(p[0], p[1]) > 0.55)
        {
            ASSERT_EQ(features[v], 0) << "vertex " << v << " of the plane";
        }
    }
    const auto count = std::accumulate(features.begin(), features.end(), std::size_t{0});
    EXPECT_GT(count, 50U);
    EXPECT_LT(count, 900U);  // the bump holds about 470 vertices
}

TEST(FeaturePoints, FollowARoundedEdge)
{
    // Two planes at a right angle joined by a quarter of a cylinder of radius 0.1 along y.
    const double radius = 0.1, flat = 1.0, quarter = radius * std::numbers::pi / 2.0;
    const IndexedMesh edge = sample_parametric(
        [=](double u, double v) {
            const double s = u * (2.0 * flat + quarter);
            if (s < flat)
            {
                return std::array{s - flat, v, radius};
            }
            if (s > flat + quarter)
            {
                return std::array{radius, v, flat + quarter - s};
            }
            const double angle = (s - flat) / radius;
            return std::array{radius * std::sin(angle), v, radius * std::cos(angle)};
        },
        86,
        40
    );
    const auto features = feature_points(link(edge), quadric_curvature(link(edge)));
    std::size_t on_edge = 0, features_on_edge = 0, features_on_planes = 0;
    for (std::size_t v = 0; v < features.size(); ++v)
    {
        const auto& p = edge.positions[v];
        const bool rounded = p[0] > 0.0 && p[2] > 0.0;
        const bool plane = p[0] < -0.15 || p[2] < -0.15;
        on_edge += rounded ? 1 : 0;
        features_on_edge += rounded ? features[v] : 0;
        features_on_planes += plane ? features[v] : 0;
    }
    EXPECT_EQ(features_on_planes, 0U);
    EXPECT_GT(features_on_edge, on_edge * 3 / 4);
}

TEST(FeaturePoints, AreFewerWhenTheRatioIsHigher)
{
    const HalfEdgeMesh torus = link(make_torus(2.0, 0.7, 40, 0.3));
    const auto curvature = quadric_curvature(torus);
    const auto count = [&](double ratio) {
        const auto features = feature_points(torus, curvature, {.ratio = ratio});
        return std::accumulate(features.begin(), features.end(), std::size_t{0});
    };
    EXPECT_GT(count(1.0), count(1.02));
    EXPECT_EQ(count(10.0), 0U);
}

TEST(FeaturePoints, DoNotDependOnTheNumberOfThreads)
{
    const HalfEdgeMesh torus = link(make_torus(2.0, 0.7, 60, 0.3));
    const auto curvature = quadric_curvature(torus);
    EXPECT_EQ(feature_points(torus, curvature, {}, 1), feature_points(torus, curvature, {}, 3));
}

TEST(SparsenessWeights, GrowWithTheDistanceBetweenSamples)
{
    // Columns get wider with x: spacing 2 x dx.
    const IndexedMesh plane = sample_parametric(
        [](double u, double v) {
            const double stretched = 0.2 * u + u * u;
            return std::array{stretched, v, 0.0};
        },
        80,
        80
    );
    const auto weights = sparseness_weights(link(plane));
    ASSERT_EQ(weights.size(), plane.positions.size());
    const std::size_t row = 40 * 81;
    EXPECT_LT(weights[row + 8] * 1.2F, weights[row + 40]);
    EXPECT_LT(weights[row + 40] * 1.2F, weights[row + 72]);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    EXPECT_NEAR(sum / static_cast<double>(weights.size()), 1.0, 1e-3);
}

TEST(SparsenessWeights, DoNotDependOnScaleOrThreads)
{
    const IndexedMesh torus = make_torus(2.0, 0.7, 60, 0.3);
    const auto weights = sparseness_weights(link(torus));
    EXPECT_EQ(weights, sparseness_weights(link(torus), 4));
    const auto large = sparseness_weights(link(moved(torus, 1000.0, {1.0, 2.0, 3.0})));
    for (std::size_t v = 0; v < weights.size(); ++v)
    {
        ASSERT_NEAR(large[v], weights[v], 1e-4F);
    }
}

}  // namespace
}  // namespace vsplit::precompute
