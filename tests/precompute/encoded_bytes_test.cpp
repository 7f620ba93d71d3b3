// The encoder makes the same bytes on every machine: tests/golden/encoded.txt holds the checksums of what
// it made on x86-64, and this test runs on AArch64, too (scripts/build-arm64).

#include "core/crc32c.h"
#include "precompute/encode_mesh.h"
#include "precompute/mesh_io.h"
#include "precompute/repair.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

namespace vsplit::test {
namespace {

using precompute::EncodeOptions;
using precompute::Metric;

constexpr const char* kList = VSPLIT_SOURCE_DIR "/tests/golden/encoded.txt";

struct Case
{
    std::string input;  ///< From the root of the repository.
    EncodeOptions options;
};

/// Every asset and golden source as users encode it; every metric; the ends of the precision.
std::vector<Case> cases()
{
    std::vector<Case> result;
    for (const char* const name : {"beast", "bone", "bracket", "dirty", "pair", "terrain"})
    {
        result.push_back({"assets/" + std::string(name) + ".ply", {}});
    }
    for (const char* const name : {"blob.ply", "book.obj", "octahedron.obj", "strip.obj"})
    {
        result.push_back({"tests/golden/" + std::string(name), {}});
    }
    for (const auto& [metric, name] : precompute::kMetricNames)
    {
        result.push_back({"assets/bone.ply", {.metric = metric}});
        result.push_back({"assets/dirty.ply", {.position_bits = 16, .metric = metric}});
    }
    result.push_back({"assets/bracket.ply", {.position_bits = 8}});
    result.push_back({"assets/terrain.ply", {.position_bits = 20, .base_vertices = 300}});
    return result;
}

/// One line: the case, the length and the checksum of its stream.
std::string describe_stream(const Case& test, unsigned threads)
{
    const IndexedMesh mesh = precompute::read_mesh(VSPLIT_SOURCE_DIR "/" + test.input).value();
    const auto repaired = precompute::repair_mesh(mesh).value();
    EncodeOptions options = test.options;
    options.threads = threads;
    const auto encoded = precompute::encode_mesh(repaired.mesh, repaired.stitches, options).value();
    std::ostringstream line;
    line << test.input << ' ' << precompute::metric_name(options.metric) << ' '
         << options.position_bits << ' ' << options.base_vertices << ' ' << encoded.file.size()
         << ' ' << std::hex << std::setw(8) << std::setfill('0') << crc32c(encoded.file);
    return line.str();
}

std::string describe_all(unsigned threads)
{
    std::string text = "input metric bits base bytes crc32c\n";
    for (const Case& test : cases())
    {
        text += describe_stream(test, threads) + '\n';
    }
    return text;
}

TEST(EncodedBytes, AreThoseOfEveryMachine)
{
    const std::string made = describe_all(1);
    if (std::getenv("VSPLIT_UPDATE_GOLDEN") != nullptr)  // by scripts/update-golden
    {
        std::ofstream(kList) << made;
    }
    std::ostringstream wanted;
    wanted << std::ifstream(kList).rdbuf();
    EXPECT_EQ(made, wanted.str());
}

TEST(EncodedBytes, DoNotDependOnTheNumberOfThreads)
{
    EXPECT_EQ(describe_all(3), describe_all(1));
}

}  // namespace
}  // namespace vsplit::test
