// Draws the levels of freshly encoded streams and looks for cracks that the original has not.
#include "codec/stream_decoder.h"
#include "picture/compare.h"
#include "picture/cracks.h"
#include "picture/decoded_surface.h"
#include "precompute/code_attributes.h"
#include "precompute/encode_mesh.h"
#include "precompute/mesh_files.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <thread>
#include <utility>

namespace vsplit::test {
namespace {

constexpr std::uint32_t kSize = 256;
constexpr std::size_t kViews = 4;
/// The complete mesh looks at least so like the original, dB.
constexpr double kLeastPsnr = 25.0;
/// Triangles drawn for one model at most, over all levels and views; levels of large ones are thinned.
constexpr std::uint64_t kMostTriangles = 40'000'000;

/// A model as it is read, and its stream.
struct EncodedModel
{
    Surface original;
    std::vector<std::uint32_t> stitches;
    std::vector<std::byte> file;
};

Result<EncodedModel> encode_model(const Surface& source)
{
    auto surface = precompute::repair_surface(source);
    VSPLIT_TRY(surface);
    EncodedModel model;
    model.original = {surface->repaired.mesh, surface->attributes, surface->groups};
    model.stitches = surface->repaired.stitches;
    auto input = precompute::make_encode_input(std::move(*surface), {});
    VSPLIT_TRY(input);
    precompute::EncodeOptions options;
    options.threads = std::max(std::thread::hardware_concurrency(), 1U);
    auto encoded = precompute::encode_surface(std::move(*input), options);
    VSPLIT_TRY(encoded);
    model.file = std::move(encoded->file);
    return model;
}

/// Mean PSNR of what is shown, dB.
double mean_psnr(
    const Surface& shown, const Surface& original, std::span<const picture::View> views
)
{
    double sum = 0.0;
    for (const picture::View& view : views)
    {
        const auto a = picture::draw({.surface = &shown}, view, {.size = kSize});
        const auto b = picture::draw({.surface = &original}, view, {.size = kSize});
        sum += picture::compare(a, b, picture::Region::Silhouettes).psnr;
    }
    return sum / static_cast<double>(views.size());
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

/// Decodes a stream and looks at its levels: none shows a crack, the last one looks like the original.
void expect_good_pictures(const EncodedModel& model, const std::string& name)
{
    const picture::CrackDetector detector(
        model.original, picture::corner_views(model.original.mesh.positions, kViews), kSize
    );
    codec::StreamDecoder decoder;
    std::span<const std::byte> rest(model.file);
    std::size_t levels = 0;
    std::size_t judged = 0;
    std::array<double, 2> psnr{};  // of the first level and the last
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
        const Surface surface = picture::decoded_surface(decoder);
        const auto count = detector.count(surface, level.max_error);
        EXPECT_EQ(count.cracked(), 0U)
            << name << ", level " << step->level << " of " << decoder.info()->levels.size() << ": "
            << count.background << " pixels show the background, " << count.see_through
            << " what lies behind, of " << count.judged << " judged";
        judged += count.judged;
        ++levels;
        if (step->level == 0 || step->level + 1 == decoder.info()->levels.size())
        {
            psnr[step->level == 0 ? 0 : 1] = mean_psnr(surface, model.original, detector.views());
        }
    }
    std::printf(
        "%-24s %3zu levels, %5.1f %% of the pixels judged, %.1f dB to %.1f dB\n",
        name.c_str(),
        levels,
        100.0 * static_cast<double>(judged) / static_cast<double>(levels * kViews * kSize * kSize),
        psnr[0],
        psnr[1]
    );
    std::fflush(stdout);  // long runs are watched
    EXPECT_GT(psnr[1], kLeastPsnr) << name;
    EXPECT_GE(psnr[1], psnr[0]) << name;
}

void expect_good_pictures_of(const std::vector<std::filesystem::path>& files)
{
    const char* const only = std::getenv("VSPLIT_ONLY");
    for (const auto& file : files)
    {
        if (only != nullptr && file.stem() != only)
        {
            continue;
        }
        const auto source = precompute::read_surface(file);
        ASSERT_TRUE(source) << file << ": " << source.error().message;
        const auto model = encode_model(source->surface);
        ASSERT_TRUE(model) << file << ": " << model.error().message;
        expect_good_pictures(*model, file.stem().string());
    }
}

/// A band with half a turn, which has but one side: repair cuts it across.
IndexedMesh moebius_band()
{
    constexpr std::uint32_t kAround = 90;
    constexpr std::uint32_t kAcross = 8;
    IndexedMesh mesh;
    for (std::uint32_t a = 0; a < kAround; ++a)
    {
        const double angle = 2.0 * std::numbers::pi * a / kAround;
        for (std::uint32_t b = 0; b <= kAcross; ++b)
        {
            const double out = 0.8 * b / kAcross - 0.4;
            const double radius = 1.0 + out * std::cos(angle / 2.0);
            mesh.positions.push_back(
                {radius * std::cos(angle), radius * std::sin(angle), out * std::sin(angle / 2.0)}
            );
        }
    }
    const auto vertex = [](std::uint32_t a, std::uint32_t b) {
        return a < kAround ? a * (kAcross + 1) + b : kAcross - b;
    };
    for (std::uint32_t a = 0; a < kAround; ++a)
    {
        for (std::uint32_t b = 0; b < kAcross; ++b)
        {
            mesh.triangles.push_back({vertex(a, b), vertex(a + 1, b), vertex(a, b + 1)});
            mesh.triangles.push_back({vertex(a, b + 1), vertex(a + 1, b), vertex(a + 1, b + 1)});
        }
    }
    return mesh;
}

TEST(LevelPictures, ShowNoCrackWhereRepairCut)
{
    Surface band;
    band.mesh = moebius_band();
    const auto model = encode_model(band);
    ASSERT_TRUE(model) << model.error().message;
    ASSERT_FALSE(model->stitches.empty());
    expect_good_pictures(*model, "moebius band");
}

TEST(LevelPictures, WouldShowCutCopiesThatMoveApart)
{
    Surface band;
    band.mesh = moebius_band();
    const auto model = encode_model(band);
    ASSERT_TRUE(model) << model.error().message;
    const picture::CrackDetector detector(
        model->original, picture::corner_views(model->original.mesh.positions), kSize
    );
    const double shift = 0.04 * detector.views().front().nearest;  // a two-hundredth of the radius
    EXPECT_EQ(detector.count(model->original, 0.0).cracked(), 0U);
    std::size_t cracked = 0;
    for (const double direction : {shift, -shift})  // one of them makes the sides overlap
    {
        Surface torn = model->original;
        for (std::uint32_t v = 0; v < model->stitches.size(); ++v)
        {
            const bool copy = model->stitches[v] != v;
            torn.mesh.positions[v][1] += copy ? direction : 0.0;
        }
        cracked += detector.count(torn, shift).cracked();
    }
    EXPECT_GT(cracked, 0U);
}

TEST(LevelPictures, ShowNoCrackInTheAssets)
{
    std::vector<std::filesystem::path> files;
    for (const char* const name : {"beast", "bone", "bracket", "dirty", "pair", "terrain"})
    {
        files.push_back(VSPLIT_SOURCE_DIR "/assets/" + std::string(name) + ".ply");
    }
    expect_good_pictures_of(files);
}

TEST(LevelPictures, ShowNoCrackInTheDevelopmentMeshes)
{
    if (model_files().empty())
    {
        GTEST_SKIP() << "no development meshes; set VSPLIT_MODELS";
    }
    expect_good_pictures_of(model_files());
}

}  // namespace
}  // namespace vsplit::test
