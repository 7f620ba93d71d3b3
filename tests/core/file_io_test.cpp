#include "core/file_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace vsplit {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed with it.
class FileIo : public testing::Test
{
protected:
    void SetUp() override
    {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("vsplit-" + std::string(test->name()) + "-" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }

    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] std::size_t files_in_folder() const
    {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator())
        );
    }

    fs::path folder_;
};

std::vector<std::byte> pattern(std::size_t count)
{
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        bytes[i] = static_cast<std::byte>(i * 31 + 7);
    }
    return bytes;
}

TEST_F(FileIo, ReadsBackWhatItWrote)
{
    const auto bytes = pattern(100'000);
    ASSERT_TRUE(write_file_atomically(folder_ / "a", bytes).has_value());
    const auto read = read_file(folder_ / "a");
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(*read, bytes);
}

TEST_F(FileIo, ReplacesAnOlderFileCompletely)
{
    ASSERT_TRUE(write_file_atomically(folder_ / "a", pattern(1000)).has_value());
    ASSERT_TRUE(write_file_atomically(folder_ / "a", pattern(10)).has_value());
    EXPECT_EQ(read_file(folder_ / "a").value(), pattern(10));
    EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(FileIo, LeavesNothingBehindWhenTheTargetCannotBeReplaced)
{
    // A folder that is not empty cannot be replaced by a file, not even by root.
    fs::create_directories(folder_ / "taken" / "inside");
    const auto result = write_file_atomically(folder_ / "taken", pattern(10));
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::IoError);
    EXPECT_EQ(files_in_folder(), 1U);
    EXPECT_TRUE(fs::is_directory(folder_ / "taken"));
}

TEST_F(FileIo, WritesIntoAPipeInsteadOfTakingItsPlace)
{
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::size_t received = 0;
    std::jthread reader([&] {
        std::ifstream in(pipe, std::ios::binary);
        received = std::string(std::istreambuf_iterator<char>(in), {}).size();
    });
    const auto result = write_file_atomically(pipe, pattern(1000));
    reader.join();
    EXPECT_TRUE(result.has_value());
    EXPECT_EQ(received, 1000U);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(FileIo, ReportsAFolderThatDoesNotExist)
{
    const auto result = write_file_atomically(folder_ / "missing" / "a", pattern(10));
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, ErrorCode::IoError);
}

TEST_F(FileIo, TellsAMissingFileFromAnUnreadableOne)
{
    EXPECT_EQ(read_file(folder_ / "missing").error().code, ErrorCode::NotFound);
    EXPECT_EQ(read_file(folder_).error().code, ErrorCode::IoError);
}

TEST_F(FileIo, RefusesFilesAboveTheLimit)
{
    ASSERT_TRUE(write_file_atomically(folder_ / "a", pattern(101)).has_value());
    EXPECT_EQ(read_file(folder_ / "a", 100).error().code, ErrorCode::InputTooLarge);
    EXPECT_TRUE(read_file(folder_ / "a", 101).has_value());
}

TEST_F(FileIo, ReadsAnEmptyFile)
{
    ASSERT_TRUE(write_file_atomically(folder_ / "empty", {}).has_value());
    const auto read = read_file(folder_ / "empty");
    ASSERT_TRUE(read.has_value());
    EXPECT_TRUE(read->empty());
}

}  // namespace
}  // namespace vsplit
