#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace vsplit::test {

/// A program that runs beside the test; killed when the object goes away.
class ChildProcess
{
public:
    /// Starts `arguments[0]` with the other arguments, its standard streams going to files in `logs`.
    /// Throws std::runtime_error when it cannot be started.
    ChildProcess(const std::vector<std::string>& arguments, const std::filesystem::path& logs);
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    /// Waits until the program ends. Returns its exit status, 128 + signal when a signal ended it, or
    /// nothing when it still runs after `limit`.
    [[nodiscard]] std::optional<int> wait(std::chrono::milliseconds limit);

    /// Sends a signal, unless the program has ended.
    void signal(int number) const;

    /// True while the program runs.
    [[nodiscard]] bool running() { return !wait(std::chrono::milliseconds(0)).has_value(); }

    /// Everything that it wrote to its standard output so far.
    [[nodiscard]] std::string output() const;

    /// Everything that it wrote to its standard error so far.
    [[nodiscard]] std::string errors() const;

private:
    std::filesystem::path output_path_;
    std::filesystem::path errors_path_;
    pid_t pid_ = -1;
    std::optional<int> status_;
};

/// What a finished program left.
struct Finished
{
    int status = -1;  ///< Exit status; -1 when it did not end in time.
    std::string output;
    std::string errors;
};

/// Runs a program to its end; kills it after `limit`.
[[nodiscard]] Finished run(
    const std::vector<std::string>& arguments,
    const std::filesystem::path& logs,
    std::chrono::milliseconds limit = std::chrono::minutes(2)
);

/// Returns the path of one of vsplit's own programs.
[[nodiscard]] std::string program(const std::string& name);

}  // namespace vsplit::test
