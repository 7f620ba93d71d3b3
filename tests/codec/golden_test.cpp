// Streams that once were made must decode to the same meshes for ever, on every machine.

#include "codec/golden_streams.h"
#include "codec/mesh_digest.h"
#include "codec/stream_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace vsplit::test {
namespace {

/// What a stream decodes to, the text of tests/golden/NAME.txt.
std::string describe_meshes(const Decoded& decoded)
{
    std::string text = kDigestHead;
    for (const Snapshot& level : decoded.levels)
    {
        text += describe_level(level.level, level.shift, level.mesh);
        for (const ShownAttributes& shown : decoded.attributes)
        {
            text += shown.level == level.level ? describe_attributes(shown.attributes) : "";
        }
    }
    return text + describe_stitches(decoded.stitches);
}

std::string read_text(const std::string& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(Golden, DecodesToTheSameMeshesAsEver)
{
    for (const GoldenStream& stream : golden_streams())
    {
        SCOPED_TRACE(stream.name);
        const Decoded decoded = decode(read_source_file(stream.path(".vsplit")));
        ASSERT_FALSE(decoded.error.has_value()) << describe(*decoded.error);
        ASSERT_TRUE(decoded.complete);
        const std::string meshes = describe_meshes(decoded);
        if (std::getenv("VSPLIT_UPDATE_GOLDEN") != nullptr)  // by scripts/update-golden
        {
            std::ofstream(stream.path(".txt")) << meshes;
            continue;
        }
        EXPECT_EQ(meshes, read_text(stream.path(".txt")));
    }
}

TEST(Golden, CoversWhatAttributesOffer)
{
    bool seams = false;
    bool groups = false;
    bool replaced = false;
    bool split = false;
    std::set<AttributeKind> kinds;
    for (const GoldenStream& stream : golden_streams())
    {
        const Bytes file = read_source_file(stream.path(".vsplit"));
        const auto info = codec::parse_stream_info(file).value();
        const Decoded decoded = decode(file);
        if (decoded.attributes.empty())
        {
            continue;
        }
        const codec::LevelAttributes& last = decoded.attributes.back().attributes;
        seams = seams || last.wedge_vertices.size() > info.vertex_count;
        groups = groups || !last.groups.empty();
        const bool grown = std::ranges::any_of(info.chunks, [](const codec::ChunkInfo& chunk) {
            return chunk.kind == proto::ChunkKind::Growth;
        });
        replaced = replaced || grown;
        split = split || !grown;
        for (std::size_t a = 0; a < info.attributes.size(); ++a)
        {
            EXPECT_FALSE(last.values[a].empty()) << stream.name;
            kinds.insert(info.attributes[a].kind);
        }
    }
    EXPECT_TRUE(seams && groups && replaced && split);
    EXPECT_EQ(kinds.size(), 3U);  // scalars are coded as texture coordinates are
}

TEST(Golden, CoversWhatTheFormatOffers)
{
    std::size_t bytes = 0;
    bool stitched = false;
    bool open = false;
    bool doubles = false;
    bool shifted = false;
    bool continued = false;
    for (const GoldenStream& stream : golden_streams())
    {
        const Bytes file = read_source_file(stream.path(".vsplit"));
        const auto info = codec::parse_stream_info(file).value();
        EXPECT_EQ(info.major, proto::kStreamMajor) << stream.name;
        EXPECT_EQ(info.minor, proto::kStreamMinor) << stream.name;
        const Decoded decoded = decode(file);
        bytes += file.size();
        stitched = stitched || !decoded.stitches.empty();
        open = open || info.face_count < 2 * (info.vertex_count - info.chunks[0].vertices);
        doubles = doubles || (file[16] & std::byte{proto::kSinglePrecisionGrid}) == std::byte{0};
        shifted = shifted || decoded.levels.front().shift > 0;
        for (const codec::ChunkInfo& chunk : info.chunks)
        {
            continued = continued || !chunk.ends_level;
        }
    }
    EXPECT_TRUE(stitched && open && doubles && shifted && continued)
        << stitched << open << doubles << shifted << continued;
    EXPECT_LT(bytes, 60000U);
}

}  // namespace
}  // namespace vsplit::test
