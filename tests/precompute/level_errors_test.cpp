#include "precompute/level_errors.h"

#include "codec/encoded_samples.h"
#include "codec/shapes.h"
#include "codec/stream_parts.h"
#include "mesh/surface_distance.h"
#include "precompute/mesh_io.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vsplit::test {
namespace {

using Positions = std::vector<std::array<float, 3>>;

Positions to_floats(const std::vector<std::array<double, 3>>& points)
{
    Positions result;
    for (const auto& [x, y, z] : points)
    {
        result.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
    return result;
}

/// The level as it is shown, model units.
Positions shown_positions(const QuantizationGrid& grid, const Snapshot& level)
{
    std::vector<std::array<double, 3>> points;
    for (const auto& index : level.mesh.positions)
    {
        points.push_back(dequantize(grid, index, level.shift));
    }
    return to_floats(points);
}

/// Compares what the index says of every level with many samples.
void expect_honest_errors(const EncodedSample& sample)
{
    const DistanceReference source(to_floats(sample.mesh.positions), sample.mesh.triangles, 30'000);
    const Decoded decoded = decode(sample.file);
    ASSERT_EQ(decoded.levels.size(), sample.info.levels.size());
    for (const Snapshot& level : decoded.levels)
    {
        SCOPED_TRACE("level " + std::to_string(level.level));
        const SurfaceDistance wanted =
            source.measure(shown_positions(sample.info.grid, level), level.mesh.triangles);
        const codec::LevelInfo& said = sample.info.levels[level.level];
        EXPECT_GT(said.rms_error, 0.85 * wanted.rms);
        EXPECT_LT(said.rms_error, 1.2 * wanted.rms);
        EXPECT_GT(said.max_error, 0.6 * wanted.max);
        EXPECT_LT(said.max_error, 2.0 * wanted.max);
    }
}

TEST(LevelErrors, OfAssetsAgreeWithManySamples)
{
    for (const char* const name : {"bone", "beast", "bracket", "terrain", "pair", "dirty"})
    {
        SCOPED_TRACE(name);
        const std::string path = VSPLIT_SOURCE_DIR "/assets/" + std::string(name) + ".ply";
        expect_honest_errors(encode(precompute::read_mesh(path).value(), {.threads = 2}));
    }
}

TEST(LevelErrors, OfShapesAgreeWithManySamples)
{
    // Hubs of more faces than a fan looks at, boundaries, holes, two components.
    const std::vector<IndexedMesh> shapes{
        double_cone(900),
        joined(fan(300), double_cone(200), 3.0),
        with_holes(height_field(40, 30, 0.4, 4), 0.08, 5),
        joined(torus(50, 20, 0.05, 1), sphere(20, 40, 0.05, 2), 4.0),
    };
    for (std::size_t i = 0; i < shapes.size(); ++i)
    {
        SCOPED_TRACE(i);
        expect_honest_errors(encode(shapes[i]));
    }
}

}  // namespace
}  // namespace vsplit::test
