#include "net/source_encoder.h"

#include "core/file_io.h"
#include "format.h"
#include "net/mapped_file.h"
#include "wire/message.h"

#include <array>
#include <cstdio>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <sys/stat.h>
#include <system_error>

namespace vsplit::net {
namespace {

/// An encoder that writes more than this has gone wrong.
constexpr std::uint64_t kMaxTargetBytes = std::uint64_t{1} << 32;
constexpr std::uint64_t kMaxListBytes = std::uint64_t{1} << 20;

using Time = std::filesystem::file_time_type;

std::string hex(std::uint64_t value)
{
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
    return text.data();
}

std::string stamp_text(const FileStamp& stamp)
{
    return std::to_string(stamp.bytes) + "/" + std::to_string(stamp.modified_ns);
}

/// Takes the server's folders out of a message that clients will read.
std::string without_folder(std::string text, const std::filesystem::path& file)
{
    const std::string folder = file.parent_path().string() + "/";
    for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
    {
        text.erase(at, folder.size());
    }
    return text;
}

std::string complaint(const ChildOutcome& outcome)
{
    switch (outcome.kind)
    {
        case ChildOutcome::Kind::TimedOut:
            return "encoding takes too long";
        case ChildOutcome::Kind::Killed:
            return "the encoder was killed, probably at its memory or time limit";
        case ChildOutcome::Kind::Exited:
        case ChildOutcome::Kind::Stopped:
            break;
    }
    constexpr std::string_view kToolName = "vsplit: ";
    std::string words = outcome.last_words;
    if (words.starts_with(kToolName))
    {
        words.erase(0, kToolName.size());
    }
    return words.empty() ? "the encoder failed with status " + std::to_string(outcome.exit_status)
                         : words;
}

/// A killed encoder leaves its temporary file (see write_file_atomically()).
void remove_leftovers(const std::filesystem::path& target, int process_id)
{
    std::error_code ignored;
    std::filesystem::remove(target.string() + "." + std::to_string(process_id) + ".tmp", ignored);
}

/// Where the names of the files that a source refers to are kept.
std::filesystem::path list_of(std::filesystem::path target)
{
    return target.replace_extension(".files");
}

/// Keeps the list of a child that has ended, as old as the child's start: what changes while a model is
/// read counts as changed.
void keep_list(const std::filesystem::path& written, const std::filesystem::path& list, Time start)
{
    // The clock of the file system may be a tick behind.
    constexpr std::chrono::milliseconds kTick{10};
    std::error_code error;
    std::filesystem::last_write_time(written, start - kTick, error);
    if (!error)
    {
        std::filesystem::rename(written, list, error);
    }
    if (error)
    {
        std::filesystem::remove(list, error);
    }
}

/// When a file or what is known of it changed last, nanoseconds; also when an older one took its place.
std::optional<std::int64_t> change_time(const std::filesystem::path& path)
{
    struct stat status = {};
    if (::stat(path.c_str(), &status) != 0)
    {
        return std::nullopt;
    }
    return status.st_ctim.tv_sec * std::int64_t{1'000'000'000} + status.st_ctim.tv_nsec;
}

}  // namespace

Result<std::filesystem::path> SourceEncoder::target_of(const std::filesystem::path& source) const
{
    if (settings_.cache.empty())
    {
        return fail(
            ErrorCode::UnsupportedInput,
            "this server does not encode source meshes (it runs without --cache)"
        );
    }
    const auto mesh = stamp_file(source);
    VSPLIT_TRY(mesh);
    if (mesh->bytes > settings_.max_source_bytes)
    {
        return fail(ErrorCode::InputTooLarge, "the source mesh is too large for this server");
    }
    const auto program = stamp_file(settings_.program);
    if (!program)
    {
        return fail(ErrorCode::EncodeFailed, "the server has no encoder program");
    }
    const std::string identity = source.string() + '\0' + stamp_text(*program) + '\0' +
                                 std::to_string(proto::kStreamMajor) + '.' +
                                 std::to_string(proto::kStreamMinor);
    const std::uint64_t hash = wire::content_id(std::as_bytes(std::span(identity)));
    // Size and time stand in the name themselves, so that only the path is left to the hash.
    return settings_.cache / (hex(hash) + "-" + hex(static_cast<std::uint64_t>(mesh->modified_ns)) +
                              "-" + std::to_string(mesh->bytes) + ".vsplit");
}

bool SourceEncoder::is_stale(
    const std::filesystem::path& source, const std::filesystem::path& target
) const
{
    const auto list = list_of(target);
    const auto stamp = stamp_file(list);
    const auto bytes = read_file(list, kMaxListBytes);
    if (!stamp || !bytes)
    {
        return false;
    }
    std::istringstream names(
        std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size())
    );
    for (std::string name; std::getline(names, name);)
    {
        const auto changed = change_time(source.parent_path() / name);
        if (changed && *changed >= stamp->modified_ns)
        {
            return true;
        }
    }
    return false;
}

void SourceEncoder::forget(const std::filesystem::path& target) const
{
    std::error_code ignored;
    std::filesystem::remove(target, ignored);
    std::filesystem::remove(list_of(target), ignored);
}

Result<void> SourceEncoder::encode(
    const std::filesystem::path& source, const std::filesystem::path& target
) const
{
    const ChildLimits limits{
        .memory_bytes = settings_.memory_bytes,
        .file_bytes = kMaxTargetBytes,
        .time = settings_.time_limit,
    };
    const auto start = Time::clock::now();
    const std::filesystem::path list = target.string() + ".list";
    const auto outcome = run_child(
        {settings_.program.string(),
         "encode",
         source.string(),
         "-o",
         target.string(),
         "--companions",
         list.string()},
        limits,
        stop_
    );
    keep_list(list, list_of(target), start);
    if (!outcome)
    {
        return fail(ErrorCode::IoError, "the server cannot start its encoder");
    }
    if (outcome->kind == ChildOutcome::Kind::Exited && outcome->exit_status == 0)
    {
        return {};
    }
    remove_leftovers(target, outcome->process_id);
    remove_leftovers(list, outcome->process_id);
    if (outcome->kind == ChildOutcome::Kind::Stopped)
    {
        return fail(ErrorCode::Cancelled, "the server shuts down");
    }
    return fail(ErrorCode::EncodeFailed, without_folder(complaint(*outcome), source));
}

}  // namespace vsplit::net
