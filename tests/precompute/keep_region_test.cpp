#include "precompute/keep_region.h"

#include "codec/shapes.h"
#include "codec/stream_parts.h"
#include "mesh/closest_point_tree.h"
#include "mesh/surface_distance.h"
#include "precompute/encode_mesh.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace vsplit::test {
namespace {

using precompute::EncodeOptions;
using precompute::KeepSphere;
using precompute::Metric;
using precompute::parse_keep_sphere;
using precompute::read_keep_mask;
using precompute::repair_mesh;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using FloatPoint = std::array<float, 3>;

TEST(KeepSphere, ReadsFourNumbers)
{
    const auto sphere = parse_keep_sphere("-1,2.5,3e2,0.25");
    ASSERT_TRUE(sphere.has_value());
    EXPECT_THAT(sphere->centre, ElementsAre(-1.0, 2.5, 300.0));
    EXPECT_EQ(sphere->radius, 0.25);
}

TEST(KeepSphere, RefusesWhatIsNone)
{
    for (const std::string text :
         {"",
          "1",
          "1,2,3",
          "1,2,3,4,5",
          "1,2,3,4,",
          "1,,3,4",
          "a,2,3,4",
          "1,2,3,0",
          "1,2,3,-1",
          "nan,2,3,4",
          "1,2,3,inf",
          "1 2 3 4"})
    {
        const auto sphere = parse_keep_sphere(text);
        ASSERT_FALSE(sphere.has_value()) << text;
        EXPECT_EQ(sphere.error().code, ErrorCode::BadRequest);
        EXPECT_THAT(sphere.error().message, HasSubstr(text + " is not x,y,z,r"));
    }
}

TEST(KeepSphere, MarksWhatLiesInIt)
{
    const IndexedMesh mesh = octahedron();
    std::vector<float> importance(mesh.positions.size(), 0.25F);
    const KeepSphere sphere{mesh.positions[2], 0.1};
    EXPECT_EQ(precompute::mark_sphere(mesh, sphere, importance), 1U);
    EXPECT_THAT(importance, ElementsAre(0.25F, 0.25F, 1.0F, 0.25F, 0.25F, 0.25F));
    const KeepSphere everything{{0.0, 0.0, 0.0}, 100.0};
    EXPECT_EQ(precompute::mark_sphere(mesh, everything, importance), 6U);
    EXPECT_THAT(importance, Each(1.0F));
    EXPECT_EQ(precompute::mark_sphere(mesh, {{50.0, 0.0, 0.0}, 1.0}, importance), 0U);
}

class KeepMask : public ::testing::Test
{
protected:
    void SetUp() override
    {
        const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = ::testing::TempDir() + "keep-mask-" + info->name() + ".txt";
    }

    void TearDown() override { std::filesystem::remove(path_); }

    [[nodiscard]] Result<std::vector<float>> read(const std::string& text, std::size_t count) const
    {
        std::ofstream(path_, std::ios::binary) << text;
        return read_keep_mask(path_, count);
    }

    std::filesystem::path path_;
};

TEST_F(KeepMask, ReadsOneNumberForEachVertex)
{
    EXPECT_THAT(read("0\n1\r\n0.5 1e-1\n\n1", 5).value(), ElementsAre(0, 1, 0.5F, 0.1F, 1));
}

TEST_F(KeepMask, RefusesAnotherLength)
{
    for (const std::string text : {"", "0 1", "0 1 0 1", "0 1 0 1 1 1 1"})
    {
        const auto mask = read(text, 3);
        ASSERT_FALSE(mask.has_value()) << text;
        EXPECT_EQ(mask.error().code, ErrorCode::UnsupportedInput);
        EXPECT_THAT(mask.error().message, HasSubstr("3 vertices"));
    }
}

TEST_F(KeepMask, RefusesOtherNumbersAndWords)
{
    for (const std::string word : {"2", "-0.5", "nan", "inf", "yes", "0,1", "1.0.0"})
    {
        const auto mask = read("0 0\n1 " + word + "\n", 4);
        ASSERT_FALSE(mask.has_value()) << word;
        EXPECT_EQ(mask.error().code, ErrorCode::UnsupportedInput);
        EXPECT_THAT(mask.error().message, HasSubstr('"' + word + "\" in line 2"));
    }
}

TEST_F(KeepMask, RefusesFilesThatAreMissingOrFarTooLarge)
{
    EXPECT_EQ(read_keep_mask(path_, 3).error().code, ErrorCode::NotFound);
    EXPECT_EQ(read(std::string(100000, ' '), 3).error().code, ErrorCode::InputTooLarge);
}

TEST(Importance, FollowsTheVerticesThroughRepair)
{
    // Vertex 3 is isolated, 4 is welded to 1; two fans meet in 0, whose copy is appended.
    const IndexedMesh mesh{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {1, 0, 0}, {0, 0, 5}, {0, -1, 5}, {1, 1, 1}},
        {{0, 1, 2}, {4, 7, 2}, {0, 5, 6}}};
    const std::vector<float> importance{0.5F, 0.1F, 0.2F, 0.9F, 0.6F, 0.3F, 0.0F, 0.7F};
    const auto repaired = repair_mesh(mesh, importance);
    ASSERT_TRUE(repaired.has_value()) << repaired.error().message;
    ASSERT_EQ(repaired->mesh.positions.size(), 7U);
    EXPECT_THAT(repaired->importance, ElementsAre(0.5F, 0.6F, 0.2F, 0.3F, 0.0F, 0.7F, 0.5F));
    EXPECT_TRUE(repair_mesh(mesh)->importance.empty());
}

TEST(Importance, MustHaveOneNumberForEachVertex)
{
    const std::vector<float> importance(5, 1.0F);
    const auto repaired = repair_mesh(octahedron(), importance);
    ASSERT_FALSE(repaired.has_value());
    EXPECT_EQ(repaired.error().code, ErrorCode::UnsupportedInput);
    EXPECT_THAT(repaired.error().message, HasSubstr("5 marks for 6 vertices"));
}

/// The beast, and a ball around one of its ends that holds about a tenth of its vertices.
class KeptRegion : public ::testing::Test
{
protected:
    void SetUp() override
    {
        auto read = precompute::read_mesh(VSPLIT_SOURCE_DIR "/assets/beast.ply");
        mesh_ = repair_mesh(read.value())->mesh;
        const auto end = std::ranges::max(mesh_.positions);
        std::vector<double> distances;
        for (const auto& point : mesh_.positions)
        {
            distances.push_back(std::hypot(point[0] - end[0], point[1] - end[1], point[2] - end[2])
            );
        }
        std::ranges::nth_element(
            distances, distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 10)
        );
        sphere_ = {end, distances[distances.size() / 10]};
        importance_.resize(mesh_.positions.size());
        marked_ = precompute::mark_sphere(mesh_, sphere_, importance_);
        level_vertices_ = static_cast<std::uint32_t>(mesh_.positions.size() / 5);
    }

    /// Encodes with levels that end at a fifth of the vertices.
    [[nodiscard]] precompute::EncodedMesh encode(
        Metric metric, const std::vector<float>& importance
    ) const
    {
        const EncodeOptions options{
            .metric = metric,
            .level_vertices = {level_vertices_},
            .importance = importance,
            .threads = 2,
        };
        return precompute::encode_mesh(mesh_, {}, options).value();
    }

    /// What the level of a fifth of the vertices makes of the region.
    struct Region
    {
        std::size_t vertices = 0;  ///< In the ball.
        double rms = 0.0;          ///< Of the region to the level's surface, model units.
    };

    [[nodiscard]] Region region_of(const precompute::EncodedMesh& encoded) const
    {
        const auto wanted =
            std::ranges::find(encoded.info.levels, level_vertices_, &codec::LevelInfo::vertices);
        const auto level = static_cast<std::size_t>(wanted - encoded.info.levels.begin());
        const Snapshot shown = test::decode(encoded.file).levels.at(level);
        IndexedMesh mesh;
        mesh.triangles = shown.mesh.triangles;
        std::vector<FloatPoint> floats;
        for (const auto& index : shown.mesh.positions)
        {
            const auto point = dequantize(encoded.info.grid, index, shown.shift);
            mesh.positions.push_back(point);
            floats.push_back(to_float(point));
        }
        Region region;
        std::vector<float> inside(mesh.positions.size());
        region.vertices = precompute::mark_sphere(mesh, sphere_, inside);
        const ClosestPointTree tree(floats, mesh.triangles);
        double sum = 0.0;
        const auto samples = region_samples();
        for (const auto& sample : samples)
        {
            std::uint32_t hint = 0;
            sum += static_cast<double>(tree.squared_distance(sample, hint));
        }
        region.rms = std::sqrt(sum / static_cast<double>(samples.size()));
        return region;
    }

    IndexedMesh mesh_;
    KeepSphere sphere_;
    std::vector<float> importance_;
    std::size_t marked_ = 0;
    std::uint32_t level_vertices_ = 0;

private:
    static FloatPoint to_float(const std::array<double, 3>& point)
    {
        return {
            static_cast<float>(point[0]),
            static_cast<float>(point[1]),
            static_cast<float>(point[2])};
    }

    /// Points on the source's triangles in the ball.
    [[nodiscard]] std::vector<FloatPoint> region_samples() const
    {
        std::vector<FloatPoint> floats;
        std::ranges::transform(mesh_.positions, std::back_inserter(floats), to_float);
        std::vector<Triangle> triangles;
        std::ranges::copy_if(
            mesh_.triangles,
            std::back_inserter(triangles),
            [&](const Triangle& triangle) {
                return std::ranges::all_of(triangle, [&](auto v) { return importance_[v] > 0.0F; });
            }
        );
        std::vector<FloatPoint> points;
        std::ranges::transform(
            sample_surface(floats, triangles, 2000),
            std::back_inserter(points),
            &SurfaceSample::point
        );
        return points;
    }
};

TEST_F(KeptRegion, HasMoreVerticesAndLessErrorAtALevelOfTheSameSize)
{
    for (const Metric metric : {Metric::Curvature, Metric::Qem, Metric::Normal, Metric::EdgeLength})
    {
        SCOPED_TRACE(precompute::metric_name(metric));
        const Region plain = region_of(encode(metric, {}));
        const Region kept = region_of(encode(metric, importance_));
        EXPECT_GT(kept.vertices, plain.vertices * 3 / 2);
        EXPECT_LT(kept.rms, plain.rms * 0.6);
    }
}

TEST_F(KeptRegion, LeavesTheLastLevelAsItIs)
{
    const auto plain = encode(Metric::Curvature, {});
    const auto kept = encode(Metric::Curvature, importance_);
    EXPECT_NE(kept.file, plain.file);
    const auto sorted_positions = [](const precompute::EncodedMesh& encoded) {
        auto positions = test::decode(encoded.file).last.mesh.positions;
        std::ranges::sort(positions);
        return positions;
    };
    const GridMesh source = quantize(kept.info.grid, mesh_);
    EXPECT_EQ(face_set(test::decode(kept.file).last.mesh), face_set(source));
    EXPECT_EQ(sorted_positions(kept), sorted_positions(plain));
}

TEST_F(KeptRegion, GivesTheSameBytesWhenNothingIsMarked)
{
    const std::vector<float> none(mesh_.positions.size(), 0.0F);
    EXPECT_EQ(encode(Metric::Curvature, none).file, encode(Metric::Curvature, {}).file);
}

TEST_F(KeptRegion, IsKeptByItsWeight)
{
    std::vector<float> half = importance_;
    std::ranges::transform(half, half.begin(), [](float value) { return value * 0.5F; });
    const std::size_t none = region_of(encode(Metric::Qem, {})).vertices;
    const std::size_t some = region_of(encode(Metric::Qem, half)).vertices;
    const std::size_t most = region_of(encode(Metric::Qem, importance_)).vertices;
    EXPECT_LT(none, some);
    EXPECT_LT(some, most);
}

TEST_F(KeptRegion, StillGivesASmallBaseWhenItIsEverything)
{
    const std::vector<float> all(mesh_.positions.size(), 1.0F);
    const auto encoded = encode(Metric::Curvature, all);
    const auto plain = encode(Metric::Curvature, {});
    EXPECT_EQ(encoded.info.levels.front().vertices, plain.info.levels.front().vertices);
    EXPECT_LE(encoded.info.levels.front().vertices, 128U);
    EXPECT_EQ(encoded.info.levels.back().vertices, mesh_.positions.size());
}

}  // namespace
}  // namespace vsplit::test
