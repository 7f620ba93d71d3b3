#include "net/options.h"

#include "net/test_streams.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vsplit::net {
namespace {

Result<std::optional<Options>> parse(std::vector<std::string> words)
{
    words.insert(words.begin(), "vsplitd");
    std::vector<const char*> arguments;
    for (const std::string& word : words)
    {
        arguments.push_back(word.c_str());
    }
    return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(ListenAddress, IsAnAddressAndAPort)
{
    EXPECT_EQ(parse_listen_address("127.0.0.1:7420")->address, "127.0.0.1");
    EXPECT_EQ(parse_listen_address("127.0.0.1:7420")->port, 7420);
    EXPECT_EQ(parse_listen_address("[::1]:0")->address, "::1");
    EXPECT_EQ(parse_listen_address(":0")->address, "127.0.0.1");
}

TEST(ListenAddress, RefusesAnythingElse)
{
    for (const std::string text :
         {"", "7420", "::1:7420", "[127.0.0.1]:1", "a:", "a:65536", "a:-1"})
    {
        EXPECT_FALSE(parse_listen_address(text)) << text;
    }
}

TEST(Options, NeedAFolderThatExists)
{
    const test::TemporaryFolder folder;
    EXPECT_EQ(parse({}).error().code, ErrorCode::BadRequest);
    EXPECT_EQ(parse({"--root", folder.path() / "none"}).error().code, ErrorCode::NotFound);
    EXPECT_EQ(parse({"--root", folder.write("f", {})}).error().code, ErrorCode::IoError);
    const auto options = parse({"--root", folder.path(), "--listen", ":0"});
    ASSERT_TRUE(options && *options);
    EXPECT_EQ((*options)->root, folder.path());
    EXPECT_TRUE((*options)->encoder.cache.empty());
    EXPECT_EQ((*options)->encoder.program.filename(), "vsplit");
}

TEST(Options, MakeTheCacheFolder)
{
    const test::TemporaryFolder folder;
    const auto cache = folder.path() / "a" / "b";
    const auto options = parse({"--root", folder.path(), "--cache", cache});
    ASSERT_TRUE(options && *options);
    EXPECT_TRUE(std::filesystem::is_directory(cache));
    EXPECT_EQ((*options)->encoder.cache, cache);
}

TEST(Options, OutOfRangeAreUsageErrors)
{
    const test::TemporaryFolder folder;
    for (const std::string option :
         {"--threads", "--max-sessions", "--idle-timeout", "--encode-time"})
    {
        const auto options = parse({"--root", folder.path(), option, "0"});
        ASSERT_FALSE(options) << option;
        EXPECT_EQ(options.error().code, ErrorCode::BadRequest);
    }
}

}  // namespace
}  // namespace vsplit::net
