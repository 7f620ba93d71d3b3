#include "core/file_io.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <unistd.h>

namespace vsplit {
namespace {

struct FileCloser
{
    void operator()(std::FILE* file) const { std::fclose(file); }
};

using File = std::unique_ptr<std::FILE, FileCloser>;

std::string reason()
{
    return std::strerror(errno);
}

// An empty span may have a null pointer, which fread and fwrite must not get.
bool read_all(std::FILE* file, std::span<std::byte> bytes)
{
    return bytes.empty() || std::fread(bytes.data(), 1, bytes.size(), file) == bytes.size();
}

bool write_all(std::FILE* file, std::span<const std::byte> bytes)
{
    return bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
}

bool write_and_flush(std::FILE* file, std::span<const std::byte> bytes)
{
    // Devices and pipes have nothing to synchronise: EINVAL.
    return write_all(file, bytes) && std::fflush(file) == 0 &&
           (::fsync(::fileno(file)) == 0 || errno == EINVAL);
}

}  // namespace

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes)
{
    std::error_code status_error;
    const auto status = std::filesystem::status(path, status_error);
    if (status.type() == std::filesystem::file_type::not_found)
    {
        return fail(ErrorCode::NotFound, "there is no file " + path.string());
    }
    if (!std::filesystem::is_regular_file(status))
    {
        return fail(ErrorCode::IoError, path.string() + " is not a regular file");
    }
    const auto size = std::filesystem::file_size(path, status_error);
    if (status_error)
    {
        return fail(
            ErrorCode::IoError, "cannot read " + path.string() + ": " + status_error.message()
        );
    }
    if (size > max_bytes)
    {
        return fail(ErrorCode::InputTooLarge, path.string() + " is too large");
    }
    const File file(std::fopen(path.c_str(), "rb"));
    std::vector<std::byte> bytes(size);
    if (!file || !read_all(file.get(), bytes))
    {
        return fail(ErrorCode::IoError, "cannot read " + path.string() + ": " + reason());
    }
    return bytes;
}

Result<void> write_file_atomically(
    const std::filesystem::path& path, std::span<const std::byte> bytes
)
{
    // A device or a pipe stays what it is: nothing may take its place.
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    const bool replace =
        !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
    const std::string temporary =
        replace ? path.string() + "." + std::to_string(::getpid()) + ".tmp" : path.string();
    File file(std::fopen(temporary.c_str(), "wb"));
    if (!file)
    {
        return fail(ErrorCode::IoError, "cannot write " + path.string() + ": " + reason());
    }
    const bool written = write_and_flush(file.get(), bytes);
    const std::string why = reason();
    file.reset();
    if (written && !replace)
    {
        return {};
    }
    if (!written || std::rename(temporary.c_str(), path.c_str()) != 0)
    {
        const std::string message = written ? reason() : why;
        if (replace)
        {
            std::remove(temporary.c_str());
        }
        return fail(ErrorCode::IoError, "cannot write " + path.string() + ": " + message);
    }
    return {};
}

}  // namespace vsplit
