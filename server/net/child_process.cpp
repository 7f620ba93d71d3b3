#include "net/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace vsplit::net {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxWords = 1024;
constexpr int kCannotStart = 127;
constexpr std::chrono::milliseconds kWaitStep{10};

/// A file descriptor that closes itself.
class Descriptor
{
public:
    explicit Descriptor(int number = -1) : number_(number) {}

    ~Descriptor() { reset(); }

    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int get() const { return number_; }

    void reset(int number = -1)
    {
        if (number_ >= 0)
        {
            ::close(number_);
        }
        number_ = number;
    }

private:
    int number_;
};

void limit(int resource, std::uint64_t value)
{
    if (value != 0)
    {
        const rlimit both{value, value};
        ::setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
    }
}

/// Becomes the program. Runs between fork and exec of a process with threads, so it may only make
/// system calls.
[[noreturn]] void become(
    char* const* arguments, const ChildLimits& limits, int null_device, int error_pipe, pid_t parent
)
{
    ::setpgid(0, 0);
    ::signal(SIGPIPE, SIG_DFL);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (::getppid() != parent)
    {
        ::_exit(kCannotStart);
    }
    ::dup2(null_device, STDIN_FILENO);
    ::dup2(null_device, STDOUT_FILENO);
    ::dup2(error_pipe, STDERR_FILENO);
    ::closefrom(STDERR_FILENO + 1);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    limit(RLIMIT_AS, limits.memory_bytes);
    limit(RLIMIT_FSIZE, limits.file_bytes);
    limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.time.count()));
    ::execv(arguments[0], arguments);
    ::_exit(kCannotStart);
}

/// Keeps what is needed to know the last line of an endless text.
class LastLine
{
public:
    void append(const char* text, std::size_t count)
    {
        text_.append(text, count);
        if (text_.size() > 2 * kMaxWords)
        {
            text_.erase(0, text_.size() - kMaxWords);
        }
    }

    [[nodiscard]] std::string get() const
    {
        const auto last = text_.find_last_not_of(" \t\r\n");
        if (last == std::string::npos)
        {
            return {};
        }
        const auto before = text_.find_last_of("\r\n", last);
        const auto first = before == std::string::npos ? 0 : before + 1;
        const std::string line = text_.substr(first, last + 1 - first);
        return line.substr(0, kMaxWords);
    }

private:
    std::string text_;
};

/// A child that was started; waits for it and kills it when it must.
class Child
{
public:
    Child(pid_t id, const ChildLimits& limits, const StopEvent& stop)
        : id_(id), stop_(stop.descriptor()), deadline_(Clock::time_point::max())
    {
        if (limits.time.count() > 0)
        {
            deadline_ = Clock::now() + limits.time;
        }
    }

    /// Collects what the child writes until it closes its end, then waits for its end.
    [[nodiscard]] ChildOutcome wait(int error_pipe)
    {
        bool open = true;
        while (open)
        {
            std::array<pollfd, 2> events{pollfd{error_pipe, POLLIN, 0}, pollfd{stop_, POLLIN, 0}};
            ::poll(events.data(), killed_ ? 1 : events.size(), poll_time());
            open = events[0].revents == 0 || read_words(error_pipe);
            kill_if_due(events[1].revents != 0);
        }
        int status = 0;
        while (::waitpid(id_, &status, WNOHANG) == 0)
        {
            pollfd event{stop_, POLLIN, 0};
            ::poll(&event, killed_ ? 0 : 1, static_cast<int>(kWaitStep.count()));
            kill_if_due(event.revents != 0);
        }
        return outcome(status);
    }

private:
    [[nodiscard]] int poll_time() const
    {
        using std::chrono::milliseconds;
        if (killed_ || deadline_ == Clock::time_point::max())
        {
            return -1;
        }
        const auto left = std::chrono::ceil<milliseconds>(deadline_ - Clock::now());
        return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 3'600'000));
    }

    [[nodiscard]] bool read_words(int error_pipe)
    {
        std::array<char, kMaxWords> buffer{};
        const ssize_t count = ::read(error_pipe, buffer.data(), buffer.size());
        if (count < 0)
        {
            return errno == EINTR || errno == EAGAIN;
        }
        words_.append(buffer.data(), static_cast<std::size_t>(count));
        return count > 0;
    }

    void kill_if_due(bool stopped)
    {
        const bool late = Clock::now() >= deadline_;
        if (killed_ || (!stopped && !late))
        {
            return;
        }
        killed_ = true;
        kind_ = stopped ? ChildOutcome::Kind::Stopped : ChildOutcome::Kind::TimedOut;
        // The group first: the child may have started others. It may not be in its group yet.
        ::kill(-id_, SIGKILL);
        ::kill(id_, SIGKILL);
    }

    [[nodiscard]] ChildOutcome outcome(int status) const
    {
        ChildOutcome outcome;
        outcome.process_id = id_;
        outcome.last_words = words_.get();
        if (killed_)
        {
            outcome.kind = kind_;
        }
        else if (WIFEXITED(status))
        {
            outcome.exit_status = WEXITSTATUS(status);
        }
        else
        {
            outcome.kind = ChildOutcome::Kind::Killed;
        }
        return outcome;
    }

    pid_t id_;
    int stop_;
    Clock::time_point deadline_;
    LastLine words_;
    bool killed_ = false;
    ChildOutcome::Kind kind_ = ChildOutcome::Kind::Killed;
};

tl::unexpected<Error> cannot_start(const std::string& program)
{
    return fail(ErrorCode::IoError, "cannot start " + program + ": " + std::strerror(errno));
}

}  // namespace

StopEvent::StopEvent() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
    if (descriptor_ < 0)
    {
        throw std::system_error(errno, std::generic_category(), "eventfd");
    }
}

StopEvent::~StopEvent()
{
    ::close(descriptor_);
}

void StopEvent::set()
{
    const std::uint64_t one = 1;
    static_cast<void>(!::write(descriptor_, &one, sizeof(one)));
}

Result<ChildOutcome> run_child(
    const std::vector<std::string>& command, const ChildLimits& limits, const StopEvent& stop
)
{
    std::vector<char*> arguments;
    for (const std::string& word : command)
    {
        arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    const Descriptor null_device(::open("/dev/null", O_RDWR | O_CLOEXEC));
    std::array<int, 2> ends{-1, -1};
    if (::access(arguments[0], X_OK) != 0 || null_device.get() < 0 ||
        ::pipe2(ends.data(), O_CLOEXEC) != 0)
    {
        return cannot_start(command.front());
    }
    const Descriptor error_read(ends[0]);
    Descriptor error_write(ends[1]);
    ::fcntl(error_read.get(), F_SETFL, O_NONBLOCK);
    const pid_t parent = ::getpid();
    const pid_t id = ::fork();
    if (id == 0)
    {
        become(arguments.data(), limits, null_device.get(), error_write.get(), parent);
    }
    if (id < 0)
    {
        return cannot_start(command.front());
    }
    error_write.reset();
    return Child(id, limits, stop).wait(error_read.get());
}

}  // namespace vsplit::net
