#pragma once

#include "core/result.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace vsplit::net {

/// Bounds of a child process; 0 means no bound.
struct ChildLimits
{
    std::uint64_t memory_bytes = 0;  ///< Address space.
    std::uint64_t file_bytes = 0;    ///< Largest file it may write.
    std::chrono::seconds time{0};    ///< Both processor time and real time.
};

/// How a child process ended.
struct ChildOutcome
{
    /// The ways to end.
    enum class Kind : std::uint8_t
    {
        Exited,    ///< By itself; see exit_status.
        Killed,    ///< By a signal: a crash or one of its limits.
        TimedOut,  ///< It ran too long and was killed.
        Stopped,   ///< The StopEvent was set and it was killed.
    };

    Kind kind = Kind::Exited;
    int exit_status = 0;     ///< When Exited.
    int process_id = 0;      ///< The number it had.
    std::string last_words;  ///< The last line it wrote to standard error, at most 1 KiB.
};

/// An event that is set once and then stays set; ends every run_child() that waits on it. Thread safe.
class StopEvent
{
public:
    /// Throws std::system_error when the system has no more descriptors.
    StopEvent();
    ~StopEvent();
    StopEvent(const StopEvent&) = delete;
    StopEvent& operator=(const StopEvent&) = delete;

    /// Sets the event.
    void set();

    /// A descriptor that is readable once the event is set.
    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    int descriptor_ = -1;
};

/// Runs a program to its end: own process group, standard input and output on /dev/null, no inherited
/// descriptors, no new privileges, killed when the calling thread ends.
/// `command`: absolute path of the program, then its arguments; `limits`: bounds it gets before it
/// starts; `stop`: kills it. Blocks. Error: IoError when it cannot be started. Thread safe.
[[nodiscard]] Result<ChildOutcome> run_child(
    const std::vector<std::string>& command, const ChildLimits& limits, const StopEvent& stop
);

}  // namespace vsplit::net
