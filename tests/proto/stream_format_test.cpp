#include "codec/attribute_coder.h"
#include "codec/batch_coder.h"
#include "codec/context_model.h"
#include "codec/error_scale.h"
#include "codec/initial_model.h"
#include "codec/small_base_coder.h"
#include "codec/stream_decoder.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"
#include "core/error.h"
#include "format.h"
#include "initial_residuals.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <map>
#include <regex>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::codec {
namespace {

using Numbers = std::map<std::string, unsigned long>;

/// The document, or its part from one heading to the next of the same depth.
std::string read_document(const std::string& heading = "")
{
    std::ifstream file(VSPLIT_SOURCE_DIR "/proto/STREAM_FORMAT.md");
    std::ostringstream stream;
    stream << file.rdbuf();
    const std::string text = stream.str();
    if (heading.empty())
    {
        return text;
    }
    const std::size_t begin = text.find("\n## " + heading + "\n");
    EXPECT_NE(begin, std::string::npos) << heading;
    return begin == std::string::npos ? ""
                                      : text.substr(begin, text.find("\n## ", begin + 4) - begin);
}

std::vector<std::smatch> matches(const std::string& text, const std::regex& pattern)
{
    return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

/// Collects name -> number from the matches of a pattern whose groups `name` and `number` hold them.
Numbers numbers(
    const std::string& text, const std::string& pattern, std::size_t name, std::size_t number
)
{
    Numbers found;
    for (const std::smatch& match : matches(text, std::regex(pattern)))
    {
        found[match[name].str()] = std::stoul(match[number].str(), nullptr, 0);
    }
    return found;
}

/// CRC-32C of a table's entries in little-endian order.
template <typename Table>
unsigned long table_crc(const Table& table)
{
    ByteWriter bytes;
    for (const auto& entry : table)
    {
        if constexpr (sizeof(entry) == 8)
        {
            bytes.write_f64(entry);
        }
        else
        {
            bytes.write(static_cast<std::make_unsigned_t<std::decay_t<decltype(entry)>>>(entry));
        }
    }
    return crc32c(bytes.view());
}

TEST(StreamFormatDocument, GivesTheConstantsOfTheCode)
{
    using namespace proto;
    const Numbers expected{
        {"kStreamMagic", kStreamMagic},
        {"kStreamMajor", kStreamMajor},
        {"kStreamMinor", kStreamMinor},
        {"kHeaderProbeBytes", kHeaderProbeBytes},
        {"kMinPositionBits", kMinPositionBits},
        {"kMaxPositionBits", kMaxPositionBits},
        {"kMaxVertices", kMaxVertices},
        {"kMaxFaces", kMaxFaces},
        {"kMaxChunks", kMaxChunks},
        {"kMaxLevels", kMaxLevels},
        {"kMaxAttributes", kMaxAttributes},
        {"kMaxGroups", kMaxGroups},
        {"kMaxAttributeBits", kMaxAttributeBits},
        {"kMaxHeaderBytes", kMaxHeaderBytes},
        {"kTargetChunkBytes", kTargetChunkBytes},
        {"kChunkChecksumBytes", kChunkChecksumBytes},
        {"kSinglePrecisionGrid", kSinglePrecisionGrid},
        {"kHasAttributes", kHasAttributes},
        {"kRgbColor", kRgbColor},
        {"kFirstOptionalChunkKind", kFirstOptionalChunkKind},
        {"kValuesCodec", kValuesCodec},
        {"kNormalsCodec", kNormalsCodec},
        {"kLateBitsCodec", kLateBitsCodec},
        {"kDracoBaseCodec", kDracoBaseCodec},
        {"kSmallBaseCodec", kSmallBaseCodec},
        {"kMaxSmallBaseVertices", kMaxSmallBaseVertices},
        {"kMaxSmallBaseFaces", kMaxSmallBaseFaces},
        {"kCrc32cResidue", kCrc32cResidue},
        {"kErrorStepsPerOctave", kErrorStepsPerOctave},
        {"kZeroErrorCode", kZeroErrorCode},
        {"kRefinementBits", kRefinementBits},
        {"kBatchCountBits", kBatchCountBits},
        {"kSplitCountBits", kSplitCountBits},
        {"kMaxWedge", kMaxWedge},
        {"kManyNeighbours", kManyNeighbours},
        {"kAdaptiveBitMemory", kAdaptiveBitMemory},
        {"kMaxCodedInteger", kMaxCodedInteger},
    };
    const std::string text = read_document("Constants");
    EXPECT_EQ(numbers(text, R"(\n\| (0x[0-9A-F]+|\d+) \| `(k\w+)` \|)", 2, 1), expected);
}

TEST(StreamFormatDocument, GivesTheVersionInItsTitle)
{
    const std::string version =
        std::to_string(proto::kStreamMajor) + "." + std::to_string(proto::kStreamMinor);
    EXPECT_TRUE(read_document().starts_with("# The vsplit stream format, version " + version + "\n")
    );
}

TEST(StreamFormatDocument, NamesEveryChunkKindWithItsNumber)
{
    const Numbers expected{
        {"Base", static_cast<unsigned long>(proto::ChunkKind::Base)},
        {"Batch", static_cast<unsigned long>(proto::ChunkKind::Batch)},
        {"Growth", static_cast<unsigned long>(proto::ChunkKind::Growth)},
        {"Parts", static_cast<unsigned long>(proto::ChunkKind::Parts)},
        {"Stitch", static_cast<unsigned long>(proto::ChunkKind::Stitch)},
        {"Attributes", static_cast<unsigned long>(proto::ChunkKind::Attributes)},
        {"Appearance", static_cast<unsigned long>(proto::ChunkKind::Appearance)},
        {"Texture", static_cast<unsigned long>(proto::ChunkKind::Texture)},
    };
    const std::string row = R"(\| (\d+) \| `(\w+)` \| (?:yes|no) \|)";
    EXPECT_EQ(numbers(read_document("Constants"), row, 2, 1), expected);
}

TEST(StreamFormatDocument, NamesTheErrorCodesWithTheirNumbers)
{
    const Numbers found = numbers(read_document("Errors"), R"(\n\| (\d+) \| ([a-z-]+) \|)", 2, 1);
    EXPECT_EQ(found.size(), 9U);
    for (const auto& [name, number] : found)
    {
        EXPECT_EQ(error_name(static_cast<ErrorCode>(number)), name);
    }
}

TEST(StreamFormatDocument, GivesTheChecksumsOfTheTables)
{
    const LearnedModel initial = initial_model();
    const Numbers expected{
        {"kSquash", table_crc(detail::kSquash)},
        {"kLogSum", table_crc(detail::kLogSum)},
        {"kAdaptation", table_crc(detail::kAdaptation)},
        {"kErrorSteps", table_crc(kErrorSteps)},
        {"kInitialResiduals", table_crc(test::initial_residuals())},
        {"kPacked", table_crc(pack_model(std::span(&initial, 1)))},
    };
    const Numbers sizes{
        {"kSquash", detail::kSquash.size()},
        {"kLogSum", detail::kLogSum.size()},
        {"kAdaptation", detail::kAdaptation.size()},
        {"kErrorSteps", kErrorSteps.size()},
        {"kInitialResiduals", test::initial_residuals().size()},
        {"kPacked", pack_model(std::span(&initial, 1)).size()},
    };
    const std::string row = R"(\n\| `(k\w+)` \| (\d+) \| \w+ \| (0x[0-9a-f]{8}) \|)";
    EXPECT_EQ(numbers(read_document(), row, 1, 3), expected);
    EXPECT_EQ(numbers(read_document(), row, 1, 2), sizes);
}

/// A table of weights as the code has it.
struct WeightTable
{
    std::string name;
    std::size_t entries = 0;

    bool operator==(const WeightTable&) const = default;
};

TEST(StreamFormatDocument, ListsTheTablesOfWeightsInTheirOrder)
{
    const ConnectivityModel model;
    std::vector<WeightTable> expected;
    const std::int32_t* next = model.split_best_edge.data();
    const auto expect = [&](const char* name, const auto& table) {
        EXPECT_EQ(table.data(), next) << name;
        next += table.size();
        expected.push_back({name, table.size()});
    };
    expect("split_best_edge", model.split_best_edge);
    expect("split_second_edge", model.split_second_edge);
    expect("split_edge_valence", model.split_edge_valence);
    expect("split_shape", model.split_shape);
    expect("split_valences", model.split_valences);
    expect("split_size", model.split_size);
    expect("kept_valence", model.kept_valence);
    expect("kept_longer_edge", model.kept_longer_edge);
    expect("kept_shorter_edge", model.kept_shorter_edge);
    expect("kept_far_edge", model.kept_far_edge);
    expect("kept_beyond", model.kept_beyond);
    expect("grow_start", model.grow_start);
    expect("grow_edge", model.grow_edge);
    expect("grow_cut_valence", model.grow_cut_valence);
    expect("grow_kept_valence", model.grow_kept_valence);
    expect("grow_beyond", model.grow_beyond);
    expect("grow_length", model.grow_length);
    expect("grow_centre", model.grow_centre);
    expect("boundary", model.boundary);
    EXPECT_EQ(
        static_cast<std::size_t>(next - model.split_best_edge.data()) * sizeof(std::int32_t),
        sizeof(ConnectivityModel)
    );

    std::vector<WeightTable> found;
    const std::string text = read_document("Connectivity");
    for (const std::smatch& row : matches(text, std::regex(R"(\n\| `([a-z]\w+)` \| (\d+) \|)")))
    {
        found.push_back({row[1].str(), std::stoul(row[2].str())});
    }
    EXPECT_EQ(found, expected);
}

TEST(StreamFormatDocument, GivesTheNumberOfIntegerModels)
{
    const GeometryModel model;
    const std::string text = read_document("Positions");
    EXPECT_EQ(
        numbers(text, R"(\| `(tangential)` \| 2 × (\d+) \|)", 1, 2).at("tangential"),
        model.tangential[0].size()
    );
    EXPECT_EQ(model.tangential.size(), 2U);
    EXPECT_EQ(
        numbers(text, R"(\| `(along_normal)` \| (\d+) \|)", 1, 2).at("along_normal"),
        model.normal.size()
    );
    EXPECT_EQ(sizeof(IntegerModel), 100 * sizeof(AdaptiveBit));
}

TEST(StreamFormatDocument, GivesTheLearningRates)
{
    const std::string text = read_document("Batch chunk");
    const std::regex formula(
        R"(split rate = max\((\d+), (\d+) / n\),  wedge rate = max\((\d+), (\d+) / n\))"
    );
    std::smatch match;
    ASSERT_TRUE(std::regex_search(text, match, formula));
    const auto rate = [&](std::size_t group, int batch) {
        return std::max(std::stoi(match[group].str()), std::stoi(match[group + 1].str()) / batch);
    };
    for (int batch = 1; batch <= 50; ++batch)
    {
        const auto rates = LearningRates::of_batch(static_cast<std::uint32_t>(batch));
        EXPECT_EQ(rates.split, rate(1, batch));
        EXPECT_EQ(rates.wedge, rate(3, batch));
    }
}

TEST(StreamFormatDocument, GivesThePredictionWeightsToBeginWith)
{
    std::string weights;
    for (const std::int8_t weight : kInitialWeights)
    {
        weights += (weights.empty() ? "" : ", ") + std::to_string(weight);
    }
    const std::string text = read_document("Initial state");
    EXPECT_NE(text.find("| prediction weights | " + weights + " |"), std::string::npos);
}

TEST(StreamFormatDocument, GivesTheBitsOfItsBinary32Constants)
{
    const std::string text = read_document("Conventions");
    const auto constants = matches(text, std::regex(R"((0\.\d+) = (0x[0-9A-F]{8}))"));
    EXPECT_EQ(constants.size(), 4U);
    for (const std::smatch& constant : constants)
    {
        const auto bits = static_cast<std::uint32_t>(std::stoul(constant[2].str(), nullptr, 16));
        EXPECT_EQ(std::bit_cast<float>(bits), std::stof(constant[1].str()));
    }
}

/// What the worked stream says that a level looks like.
struct ShownLevel
{
    std::vector<std::array<std::int32_t, 3>> positions;
    std::vector<Triangle> triangles;
};

/// Collects the bytes with which the lines of the worked stream begin.
std::vector<std::byte> worked_bytes(const std::string& text)
{
    std::vector<std::byte> bytes;
    for (const std::smatch& line :
         matches(text, std::regex(R"(\n    ((?:[0-9a-f]{2} )*[0-9a-f]{2})(?=  |\n))")))
    {
        std::istringstream parts(line[1].str());
        for (std::string part; parts >> part;)
        {
            bytes.push_back(static_cast<std::byte>(std::stoul(part, nullptr, 16)));
        }
    }
    return bytes;
}

std::vector<ShownLevel> worked_levels(const std::string& text)
{
    const std::regex line(R"(\n    (level|vertex|triangle) \d+: (?:\((\d+), (\d+), (\d+)\))?)");
    std::vector<ShownLevel> levels;
    for (const std::smatch& match : matches(text, line))
    {
        if (match[1] == "level")
        {
            levels.emplace_back();
            continue;
        }
        const std::array<std::int32_t, 3> three{
            std::stoi(match[2].str()), std::stoi(match[3].str()), std::stoi(match[4].str())};
        if (match[1] == "vertex")
        {
            levels.back().positions.push_back(three);
        }
        else
        {
            levels.back().triangles.push_back(
                {static_cast<std::uint32_t>(three[0]),
                 static_cast<std::uint32_t>(three[1]),
                 static_cast<std::uint32_t>(three[2])}
            );
        }
    }
    return levels;
}

void expect_level(const StreamDecoder& decoder, const ShownLevel& level)
{
    ASSERT_EQ(decoder.vertices(), level.positions.size());
    for (std::uint32_t v = 0; v < decoder.vertices(); ++v)
    {
        EXPECT_EQ(decoder.grid_position(v), level.positions[v]) << "vertex " << v;
    }
    std::vector<Triangle> triangles(decoder.faces());
    decoder.write_triangles(triangles);
    EXPECT_EQ(triangles, level.triangles);
}

TEST(StreamFormatDocument, ShowsAWorkedStreamThatDecodesToTheMeshesItShows)
{
    const std::string text = read_document("Worked stream");
    const std::vector<std::byte> bytes = worked_bytes(text);
    const std::vector<ShownLevel> levels = worked_levels(text);
    ASSERT_EQ(levels.size(), 2U);

    StreamDecoder decoder;
    std::span<const std::byte> rest = bytes;
    while (!decoder.complete())
    {
        const auto taken = decoder.feed(rest);
        ASSERT_TRUE(taken) << describe(taken.error());
        rest = rest.subspan(*taken);
        const auto step = decoder.step();
        ASSERT_TRUE(step) << describe(step.error());
        ASSERT_TRUE(*taken > 0 || step->kind != StepKind::NeedBytes);
        if (step->level_complete)
        {
            ASSERT_LT(step->level, levels.size());
            expect_level(decoder, levels[step->level]);
        }
    }
    EXPECT_EQ(decoder.level(), 1U);
    EXPECT_TRUE(rest.empty());
}

}  // namespace
}  // namespace vsplit::codec
