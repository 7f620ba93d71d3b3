#include "integration/child_process.h"

#include <array>
#include <atomic>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vsplit::test {
namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(5);

std::string contents(const std::filesystem::path& path)
{
    const std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Standard input is empty, the other two streams go to files: a full pipe can block nobody.
class FileActions
{
public:
    FileActions(const std::string& output, const std::string& errors)
    {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, output.c_str(), flags, 0644);
        posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, errors.c_str(), flags, 0644);
    }

    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;

    ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }

    [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
};

}  // namespace

ChildProcess::ChildProcess(
    const std::vector<std::string>& arguments, const std::filesystem::path& logs
)
{
    static std::atomic<int> counter{0};
    const std::string name = std::filesystem::path(arguments.front()).filename().string() + "-" +
                             std::to_string(counter++);
    output_path_ = logs / (name + ".out");
    errors_path_ = logs / (name + ".err");
    std::vector<char*> pointers;
    for (const auto& argument : arguments)
    {
        pointers.push_back(const_cast<char*>(argument.c_str()));
    }
    pointers.push_back(nullptr);
    const FileActions actions(output_path_.string(), errors_path_.string());
    if (::posix_spawn(&pid_, pointers[0], actions.get(), nullptr, pointers.data(), environ) != 0)
    {
        pid_ = -1;
        throw std::runtime_error("cannot start " + arguments.front());
    }
}

ChildProcess::~ChildProcess()
{
    if (running())
    {
        signal(SIGKILL);
        static_cast<void>(wait(std::chrono::minutes(1)));
    }
}

std::optional<int> ChildProcess::wait(std::chrono::milliseconds limit)
{
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (!status_)
    {
        int raw = 0;
        if (::waitpid(pid_, &raw, WNOHANG) == pid_)
        {
            status_ = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
        }
        else if (std::chrono::steady_clock::now() >= deadline)
        {
            break;
        }
        else
        {
            std::this_thread::sleep_for(kPollInterval);
        }
    }
    return status_;
}

void ChildProcess::signal(int number) const
{
    if (!status_)
    {
        ::kill(pid_, number);
    }
}

std::string ChildProcess::output() const
{
    return contents(output_path_);
}

std::string ChildProcess::errors() const
{
    return contents(errors_path_);
}

Finished run(
    const std::vector<std::string>& arguments,
    const std::filesystem::path& logs,
    std::chrono::milliseconds limit
)
{
    ChildProcess child(arguments, logs);
    const int status = child.wait(limit).value_or(-1);
    return {status, child.output(), child.errors()};
}

std::string program(const std::string& name)
{
    return std::string(VSPLIT_BIN_DIR) + "/" + name;
}

}  // namespace vsplit::test
