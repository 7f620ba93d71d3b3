#include "net/model_library.h"

#include "net/test_streams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <future>
#include <thread>
#include <vector>

namespace vsplit::net {
namespace {

using test::Bytes;

/// Stands in for the vsplit tool where a test needs an encoder that misbehaves: a real child process
/// that copies the source, which here is a stream already. Its last argument is the target.
constexpr const char* kCopy = "#!/bin/sh\necho run >> \"$0.log\"\nsleep 0.2\ncp \"$2\" \"$4\"\n";

/// Longer than a file system's clock is behind.
constexpr std::chrono::milliseconds kClockTicks{50};

class ModelLibraryTest : public testing::Test
{
protected:
    ModelLibraryTest()
    {
        std::filesystem::create_directories(root_);
        std::filesystem::create_directories(cache_);
        folder_.write("root/cow.vsplit", file_);
        folder_.write("root/source.ply", file_);
        use_encoder(kCopy);
    }

    void use_encoder(const std::string& script)
    {
        settings_.program = folder_.write_program("encoder", script);
        settings_.cache = cache_;
    }

    static std::future<Result<StreamPtr>> ask(ModelLibrary& library, const std::string& name)
    {
        auto promise = std::make_shared<std::promise<Result<StreamPtr>>>();
        auto future = promise->get_future();
        library.find(name, [promise](Result<StreamPtr> stream) {
            promise->set_value(std::move(stream));
        });
        return future;
    }

    Result<StreamPtr> find(const std::string& name)
    {
        ModelLibrary library(root_, settings_);
        return ask(library, name).get();
    }

    [[nodiscard]] std::ptrdiff_t runs() const
    {
        std::ifstream log(settings_.program.string() + ".log");
        return std::count(std::istreambuf_iterator<char>(log), {}, '\n');
    }

    [[nodiscard]] std::ptrdiff_t cached_files() const
    {
        return std::distance(std::filesystem::directory_iterator(cache_), {});
    }

    test::TemporaryFolder folder_;
    std::filesystem::path root_ = folder_.path() / "root";
    std::filesystem::path cache_ = folder_.path() / "cache";
    Bytes file_ = test::make_stream_file({300, 200}, 1);
    EncoderSettings settings_;
};

TEST_F(ModelLibraryTest, FindsStreams)
{
    const auto stream = find("cow");
    ASSERT_TRUE(stream) << describe(stream.error());
    EXPECT_TRUE(std::ranges::equal((*stream)->bytes, file_));
    EXPECT_EQ(find("dog").error().code, ErrorCode::NotFound);
    EXPECT_EQ(find("../root/cow").error().code, ErrorCode::NotFound);
}

TEST_F(ModelLibraryTest, EncodesASourceOnceHoweverManyAsk)
{
    ModelLibrary library(root_, settings_);
    std::vector<std::future<Result<StreamPtr>>> answers;
    for (int i = 0; i < 20; ++i)
    {
        answers.push_back(ask(library, "source.ply"));
    }
    for (auto& answer : answers)
    {
        const auto stream = answer.get();
        ASSERT_TRUE(stream) << describe(stream.error());
        EXPECT_TRUE(std::ranges::equal((*stream)->bytes, file_));
    }
    EXPECT_TRUE(ask(library, "source.ply").get());
    EXPECT_EQ(runs(), 1);
    EXPECT_EQ(cached_files(), 1);
}

TEST_F(ModelLibraryTest, RemembersTheEncodedFormAcrossRestarts)
{
    EXPECT_TRUE(find("source"));
    EXPECT_TRUE(find("source"));
    EXPECT_EQ(runs(), 1);
}

TEST_F(ModelLibraryTest, EncodesAgainWhenTheSourceHasChanged)
{
    EXPECT_TRUE(find("source.ply"));
    const Bytes changed = test::make_stream_file({300, 200}, 2);
    folder_.write("root/source.ply", changed);
    const auto stream = find("source.ply");
    ASSERT_TRUE(stream) << describe(stream.error());
    EXPECT_TRUE(std::ranges::equal((*stream)->bytes, changed));
    EXPECT_EQ(runs(), 2);
}

TEST_F(ModelLibraryTest, EncodesAgainWhenWhatTheSourceRefersToHasChanged)
{
    // Lists two companions as the real tool does: one is there, one is missing.
    use_encoder(std::string(kCopy) + "printf 'maps/skin.png\\nhair.png\\n' > \"$6\"\n");
    folder_.write("root/maps/skin.png", file_);
    std::this_thread::sleep_for(kClockTicks);
    ModelLibrary library(root_, settings_);
    EXPECT_TRUE(ask(library, "source.ply").get());
    EXPECT_TRUE(ask(library, "source.ply").get());
    EXPECT_EQ(runs(), 1);
    folder_.write("root/other.png", file_);
    EXPECT_TRUE(ask(library, "source.ply").get());
    EXPECT_EQ(runs(), 1) << "nothing refers to that one";
    for (const std::string changed : {"root/maps/skin.png", "root/hair.png"})
    {
        const auto before = runs();
        std::this_thread::sleep_for(kClockTicks);
        folder_.write(changed, file_);
        std::this_thread::sleep_for(kClockTicks);
        EXPECT_TRUE(ask(library, "source.ply").get());
        EXPECT_TRUE(ask(library, "source.ply").get());
        EXPECT_EQ(runs(), before + 1) << changed;
    }
}

TEST_F(ModelLibraryTest, TriesAgainWhenWhatMadeTheEncoderFailHasChanged)
{
    use_encoder("#!/bin/sh\necho run >> \"$0.log\"\necho skin.png > \"$6\"\nexit 3\n");
    folder_.write("root/skin.png", file_);
    std::this_thread::sleep_for(kClockTicks);
    ModelLibrary library(root_, settings_);
    EXPECT_FALSE(ask(library, "source.ply").get());
    EXPECT_FALSE(ask(library, "source.ply").get());
    EXPECT_EQ(runs(), 1);
    std::this_thread::sleep_for(kClockTicks);
    folder_.write("root/skin.png", file_);
    EXPECT_FALSE(ask(library, "source.ply").get());
    EXPECT_EQ(runs(), 2);
}

TEST_F(ModelLibraryTest, ReplacesADamagedCacheFile)
{
    EXPECT_TRUE(find("source.ply"));
    const auto entry = *std::filesystem::directory_iterator(cache_);
    std::filesystem::resize_file(entry.path(), 50);
    EXPECT_TRUE(find("source.ply"));
    EXPECT_EQ(runs(), 2);
}

TEST_F(ModelLibraryTest, OtherModelsAreServedWhileOneIsEncoded)
{
    use_encoder("#!/bin/sh\nsleep 30\n");
    ModelLibrary library(root_, settings_);
    auto slow = ask(library, "source.ply");
    EXPECT_TRUE(ask(library, "cow").get());
    EXPECT_NE(slow.wait_for(std::chrono::seconds(0)), std::future_status::ready);
    library.stop();
    EXPECT_EQ(slow.get().error().code, ErrorCode::Cancelled);
}

TEST_F(ModelLibraryTest, FailureOfTheEncoderIsPassedOnWithoutFoldersAndRemembered)
{
    use_encoder("#!/bin/sh\necho run >> \"$0.log\"\necho \"bad: $2 is no mesh\" >&2\nexit 3\n");
    ModelLibrary library(root_, settings_);
    for (int i = 0; i < 2; ++i)
    {
        const auto stream = ask(library, "source.ply").get();
        ASSERT_FALSE(stream);
        EXPECT_EQ(stream.error().code, ErrorCode::EncodeFailed);
        EXPECT_EQ(stream.error().message, "bad: source.ply is no mesh");
    }
    EXPECT_EQ(runs(), 1);
    EXPECT_EQ(cached_files(), 0);
}

TEST_F(ModelLibraryTest, EncoderThatHangsIsKilled)
{
    use_encoder("#!/bin/sh\necho half > \"$4.$$.tmp\"\nsleep 60\n");
    settings_.time_limit = std::chrono::seconds(1);
    const auto stream = find("source.ply");
    ASSERT_FALSE(stream);
    EXPECT_EQ(stream.error().code, ErrorCode::EncodeFailed);
    EXPECT_EQ(cached_files(), 0);
}

TEST_F(ModelLibraryTest, EncoderThatWritesRubbishIsNoticedOnce)
{
    use_encoder("#!/bin/sh\necho run >> \"$0.log\"\necho rubbish > \"$4\"\n");
    ModelLibrary library(root_, settings_);
    for (int i = 0; i < 2; ++i)
    {
        const auto stream = ask(library, "source.ply").get();
        ASSERT_FALSE(stream);
        EXPECT_EQ(stream.error().code, ErrorCode::EncodeFailed);
    }
    EXPECT_EQ(runs(), 1);
    EXPECT_EQ(cached_files(), 0);
}

TEST_F(ModelLibraryTest, SourcesNeedACacheAnEncoderAndASaneSize)
{
    settings_.max_source_bytes = 10;
    EXPECT_EQ(find("source.ply").error().code, ErrorCode::InputTooLarge);
    settings_.max_source_bytes = 1U << 20;
    settings_.program = folder_.path() / "missing";
    EXPECT_EQ(find("source.ply").error().code, ErrorCode::EncodeFailed);
    settings_.cache.clear();
    EXPECT_EQ(find("source.ply").error().code, ErrorCode::UnsupportedInput);
}

}  // namespace
}  // namespace vsplit::net
