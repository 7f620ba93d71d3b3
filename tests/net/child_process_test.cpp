#include "net/child_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fcntl.h>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

namespace vsplit::net {
namespace {

using Kind = ChildOutcome::Kind;

Result<ChildOutcome> shell(const std::string& script, const ChildLimits& limits = {})
{
    const StopEvent never;
    return run_child({"/bin/sh", "-c", script}, limits, never);
}

TEST(RunChild, ReportsStatusAndLastLine)
{
    const auto outcome = shell("echo first >&2; echo 'bad mesh' >&2; echo >&2; exit 3");
    ASSERT_TRUE(outcome) << describe(outcome.error());
    EXPECT_EQ(outcome->kind, Kind::Exited);
    EXPECT_EQ(outcome->exit_status, 3);
    EXPECT_EQ(outcome->last_words, "bad mesh");
    EXPECT_EQ(shell("exit 0")->last_words, "");
}

TEST(RunChild, SurvivesAChildThatTalksTooMuch)
{
    const auto outcome = shell("head -c 3000000 /dev/zero | tr '\\0' x >&2; echo end >&2");
    ASSERT_TRUE(outcome) << describe(outcome.error());
    EXPECT_EQ(outcome->exit_status, 0);
    EXPECT_LE(outcome->last_words.size(), 1024U);
}

TEST(RunChild, KillsWhatTakesTooLong)
{
    const ChildLimits limits{.time = std::chrono::seconds(1)};
    EXPECT_EQ(shell("exec sleep 60", limits)->kind, Kind::TimedOut);
    // Also when its end of the pipe is closed, and also its own children.
    EXPECT_EQ(shell("exec 2>&-; sleep 60; true", limits)->kind, Kind::TimedOut);
}

TEST(RunChild, StopEventKillsIt)
{
    StopEvent stop;
    std::jthread stopper([&stop] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        stop.set();
    });
    EXPECT_EQ(run_child({"/bin/sleep", "60"}, {}, stop)->kind, Kind::Stopped);
    stopper.join();
    EXPECT_EQ(run_child({"/bin/sleep", "60"}, {}, stop)->kind, Kind::Stopped);
}

TEST(RunChild, EnforcesItsLimits)
{
    const ChildLimits limits{.memory_bytes = 1U << 28, .file_bytes = 4096};
    const auto memory = shell("ulimit -v", limits);
    ASSERT_TRUE(memory);
    EXPECT_EQ(shell("test \"$(ulimit -v)\" = 262144", limits)->exit_status, 0);
    EXPECT_NE(shell("test \"$(ulimit -v)\" = 262144")->exit_status, 0);
    EXPECT_EQ(shell("kill -SEGV $$")->kind, Kind::Killed);
}

TEST(RunChild, InheritsNoDescriptor)
{
    const int open_file = ::open("/dev/null", O_RDONLY);
    ASSERT_GE(open_file, 3);
    const std::string number = std::to_string(open_file);
    EXPECT_EQ(shell("test -e /proc/self/fd/" + number)->exit_status, 1);
    EXPECT_EQ(shell("test -e /proc/self/fd/2")->exit_status, 0);
    ::close(open_file);
}

TEST(RunChild, SaysSoWhenThereIsNoProgram)
{
    const StopEvent never;
    const auto outcome = run_child({"/nonexistent/program"}, {}, never);
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error().code, ErrorCode::IoError);
}

}  // namespace
}  // namespace vsplit::net
