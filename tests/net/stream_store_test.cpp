#include "net/stream_store.h"

#include "net/test_streams.h"
#include "wire/message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace vsplit::net {
namespace {

using test::Bytes;

class StreamStoreTest : public testing::Test
{
protected:
    ErrorCode code_of(const Bytes& file)
    {
        const auto stream = store_.open(folder_.write("m.vsplit", file));
        return stream ? ErrorCode::Ok : stream.error().code;
    }

    test::TemporaryFolder folder_;
    StreamStore store_;
};

TEST_F(StreamStoreTest, GivesTheBytesIndexAndIdOfAFile)
{
    const Bytes file = test::make_stream_file({300, 40, 70'000}, 1);
    const auto stream = store_.open(folder_.write("m.vsplit", file));
    ASSERT_TRUE(stream) << describe(stream.error());
    EXPECT_TRUE(std::ranges::equal((*stream)->bytes, file));
    EXPECT_EQ((*stream)->info.levels.size(), 3U);
    const auto header = std::span(file).first((*stream)->info.header_bytes);
    EXPECT_EQ((*stream)->content_id, wire::content_id(header));
}

TEST_F(StreamStoreTest, SharesAFileWhileItIsInUse)
{
    const auto path = folder_.write("m.vsplit", test::make_stream_file({300, 40}, 1));
    const auto first = store_.open(path);
    const auto second = store_.open(path);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
}

TEST_F(StreamStoreTest, NoticesThatAFileWasReplaced)
{
    const Bytes old_file = test::make_stream_file({300, 40}, 1);
    const auto before = store_.open(folder_.write("m.vsplit", old_file));
    const auto after = store_.open(folder_.write("m.vsplit", test::make_stream_file({300, 40}, 2)));
    ASSERT_TRUE(before && after);
    EXPECT_NE((*before)->content_id, (*after)->content_id);
    // Sessions that still hold the old file go on with its bytes.
    EXPECT_TRUE(std::ranges::equal((*before)->bytes, old_file));
}

TEST_F(StreamStoreTest, RefusesEveryTruncation)
{
    const Bytes file = test::make_stream_file({60, 20}, 3);
    for (std::size_t length = 0; length < file.size(); ++length)
    {
        EXPECT_NE(code_of(Bytes(file.begin(), file.begin() + length)), ErrorCode::Ok) << length;
    }
    EXPECT_EQ(code_of(Bytes(file.begin(), file.end() - 1)), ErrorCode::Truncated);
    EXPECT_EQ(code_of(file), ErrorCode::Ok);
}

TEST_F(StreamStoreTest, RefusesTrailingBytes)
{
    EXPECT_EQ(
        code_of(test::joined(test::make_stream_file({60, 20}, 3), Bytes(1))),
        ErrorCode::TrailingBytes
    );
}

TEST_F(StreamStoreTest, RefusesADamagedByteAnywhere)
{
    const Bytes file = test::make_stream_file({60, 20}, 3);
    for (std::size_t i = 0; i < file.size(); ++i)
    {
        Bytes damaged = file;
        damaged[i] ^= std::byte{0x20};
        EXPECT_NE(code_of(damaged), ErrorCode::Ok) << i;
    }
}

TEST_F(StreamStoreTest, VerifiesAgainWhenTheFileHasChanged)
{
    Bytes file = test::make_stream_file({60, 20}, 3);
    ASSERT_EQ(code_of(file), ErrorCode::Ok);
    file.back() ^= std::byte{1};
    EXPECT_EQ(code_of(file), ErrorCode::BadChecksum);
}

TEST_F(StreamStoreTest, RefusesWhatIsNoFile)
{
    EXPECT_EQ(store_.open(folder_.path() / "none").error().code, ErrorCode::NotFound);
    EXPECT_EQ(store_.open(folder_.path()).error().code, ErrorCode::IoError);
}

TEST_F(StreamStoreTest, ObeysItsLimits)
{
    StreamStore strict(codec::DecodeLimits{.max_chunk_bytes = 50});
    const auto stream = strict.open(folder_.write("m.vsplit", test::make_stream_file({60}, 1)));
    ASSERT_FALSE(stream);
    EXPECT_EQ(stream.error().code, ErrorCode::LimitExceeded);
}

TEST_F(StreamStoreTest, ReportsAFileThatWasCutWhileItWasMapped)
{
    const auto path = folder_.write("m.vsplit", test::make_stream_file({60'000}, 1));
    const auto file = MappedFile::open(path);
    ASSERT_TRUE(file) << describe(file.error());
    std::filesystem::resize_file(path, 100);
    Bytes block(1000);
    const auto read = file->read(50'000, block);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::Truncated);
}

}  // namespace
}  // namespace vsplit::net
