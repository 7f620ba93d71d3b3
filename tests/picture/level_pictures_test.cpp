// Draws the levels of freshly encoded streams and looks for cracks that the original has not.
#include "codec/stream_decoder.h"
#include "picture/cracks.h"
#include "picture/decoded_surface.h"
#include "precompute/encode_mesh.h"
#include "precompute/mesh_files.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <thread>

namespace vsplit::test {
namespace {

constexpr std::uint32_t kSize = 256;
constexpr std::size_t kViews = 4;
/// Triangles drawn for one model at most, over all levels and views; levels of large ones are thinned.
constexpr std::uint64_t kMostTriangles = 40'000'000;

/// A model as it is read, and its stream.
struct EncodedModel
{
    Surface original;
    std::vector<std::byte> file;
};

Result<EncodedModel> encode_file(const std::filesystem::path& path)
{
    const auto mesh = precompute::read_mesh(path);
    VSPLIT_TRY(mesh);
    auto repaired = precompute::repair_mesh(*mesh);
    VSPLIT_TRY(repaired);
    precompute::EncodeOptions options;
    options.threads = std::max(std::thread::hardware_concurrency(), 1U);
    auto encoded = precompute::encode_mesh(repaired->mesh, repaired->stitches, options);
    VSPLIT_TRY(encoded);
    EncodedModel model;
    model.original.mesh = std::move(repaired->mesh);
    model.file = std::move(encoded->file);
    return model;
}

/// True for the levels that are drawn: all, or evenly spread ones; always the first and the last.
bool is_drawn(const codec::StreamInfo& info, std::uint32_t level)
{
    std::uint64_t triangles = 0;
    for (const codec::LevelInfo& row : info.levels)
    {
        triangles += kViews * row.faces;
    }
    const auto stride = static_cast<std::uint32_t>(triangles / kMostTriangles + 1);
    return level % stride == 0 || level + 1 == info.levels.size();
}

/// Decodes a stream and looks at its levels.
void expect_no_cracks(const EncodedModel& model, const std::string& name)
{
    const picture::CrackDetector detector(
        model.original, picture::corner_views(model.original.mesh.positions, kViews), kSize
    );
    codec::StreamDecoder decoder;
    std::span<const std::byte> rest(model.file);
    std::size_t levels = 0;
    std::size_t judged = 0;
    while (!decoder.complete())
    {
        const auto taken = decoder.feed(rest);
        ASSERT_TRUE(taken) << name << ": " << taken.error().message;
        rest = rest.subspan(*taken);
        const auto step = decoder.step();
        ASSERT_TRUE(step) << name << ": " << step.error().message;
        const bool shown = step->level_complete || step->attributes_complete;
        if (!shown || !is_drawn(*decoder.info(), step->level))
        {
            continue;
        }
        const codec::LevelInfo& level = decoder.info()->levels[step->level];
        const auto count = detector.count(picture::decoded_surface(decoder), level.max_error);
        EXPECT_EQ(count.cracked(), 0U)
            << name << ", level " << step->level << " of " << decoder.info()->levels.size() << ": "
            << count.background << " pixels show the background, " << count.see_through
            << " what lies behind, of " << count.judged << " judged";
        judged += count.judged;
        ++levels;
    }
    std::printf(
        "%-24s %3zu levels, %5.1f %% of the pixels judged\n",
        name.c_str(),
        levels,
        100.0 * static_cast<double>(judged) / static_cast<double>(levels * kViews * kSize * kSize)
    );
}

void expect_no_cracks_in(const std::vector<std::filesystem::path>& files)
{
    const char* const only = std::getenv("VSPLIT_ONLY");
    for (const auto& file : files)
    {
        if (only != nullptr && file.stem() != only)
        {
            continue;
        }
        const auto model = encode_file(file);
        ASSERT_TRUE(model) << file << ": " << model.error().message;
        expect_no_cracks(*model, file.stem().string());
    }
}

TEST(LevelPictures, ShowNoCrackInTheAssets)
{
    std::vector<std::filesystem::path> files;
    for (const char* const name : {"beast", "bone", "bracket", "dirty", "pair", "terrain"})
    {
        files.push_back(VSPLIT_SOURCE_DIR "/assets/" + std::string(name) + ".ply");
    }
    expect_no_cracks_in(files);
}

TEST(LevelPictures, ShowNoCrackInTheDevelopmentMeshes)
{
    if (model_files().empty())
    {
        GTEST_SKIP() << "no development meshes; set VSPLIT_MODELS";
    }
    expect_no_cracks_in(model_files());
}

}  // namespace
}  // namespace vsplit::test
