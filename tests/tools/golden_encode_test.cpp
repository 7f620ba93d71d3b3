// The encoder makes the golden streams byte for byte, so that a change of its output is never made
// unnoticed; after one that is wanted: scripts/update-golden.

#include "codec/golden_streams.h"
#include "tools/tool_fixture.h"

#include <fstream>
#include <sstream>

namespace vsplit::test {
namespace {

class GoldenEncode : public VsplitTool
{
};

TEST_F(GoldenEncode, GivesTheGoldenStreamsAgain)
{
#ifndef __x86_64__
    GTEST_SKIP() << "the encoder's mathematical library rounds differently on other processors";
#endif
    for (const GoldenStream& stream : golden_streams())
    {
        SCOPED_TRACE(stream.name);
        const std::string input = VSPLIT_SOURCE_DIR "/" + stream.input;
        std::vector<std::string> arguments{"encode", input, "-o", path("made.vsplit"), "--quiet"};
        arguments.insert(arguments.end(), stream.options.begin(), stream.options.end());
        const Finished finished = run(arguments);
        ASSERT_EQ(finished.status, 0) << finished.err;
        std::ifstream golden(stream.path(".vsplit"), std::ios::binary);
        std::ostringstream wanted;
        wanted << golden.rdbuf();
        EXPECT_TRUE(load("made.vsplit") == wanted.str());
    }
}

TEST_F(GoldenEncode, MakesStreamsThatVerifyAgainstTheirSources)
{
    for (const GoldenStream& stream : golden_streams())
    {
        const std::string input = VSPLIT_SOURCE_DIR "/" + stream.input;
        const Finished finished = run({"verify", stream.path(".vsplit"), "--against", input});
        EXPECT_EQ(finished.status, 0) << stream.name << ": " << finished.err;
    }
}

}  // namespace
}  // namespace vsplit::test
