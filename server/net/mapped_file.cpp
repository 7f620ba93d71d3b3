#include "net/mapped_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace vsplit::net {
namespace {

tl::unexpected<Error> system_failure(const std::filesystem::path& path)
{
    const int reason = errno;
    const bool missing = reason == ENOENT || reason == ENOTDIR;
    return fail(
        missing ? ErrorCode::NotFound : ErrorCode::IoError,
        "cannot open " + path.string() + ": " + std::strerror(reason)
    );
}

Result<FileStamp> stamp_of(const struct stat& status, const std::filesystem::path& path)
{
    if (!S_ISREG(status.st_mode))
    {
        return fail(ErrorCode::IoError, path.string() + " is not a regular file");
    }
    constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
    return FileStamp{
        .device = status.st_dev,
        .inode = status.st_ino,
        .bytes = static_cast<std::uint64_t>(status.st_size),
        .modified_ns = status.st_mtim.tv_sec * kNanosecondsPerSecond + status.st_mtim.tv_nsec,
    };
}

}  // namespace

Result<FileStamp> stamp_file(const std::filesystem::path& path)
{
    struct stat status = {};
    if (::stat(path.c_str(), &status) != 0)
    {
        return system_failure(path);
    }
    return stamp_of(status, path);
}

Result<MappedFile> MappedFile::open(const std::filesystem::path& path)
{
    // O_NONBLOCK keeps the call from hanging on a pipe, before fstat can refuse it.
    MappedFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat status = {};
    if (file.descriptor_ < 0 || ::fstat(file.descriptor_, &status) != 0)
    {
        return system_failure(path);
    }
    const auto stamp = stamp_of(status, path);
    VSPLIT_TRY(stamp);
    if (stamp->bytes == 0)
    {
        return fail(ErrorCode::Truncated, "the file is empty");
    }
    void* const map = ::mmap(nullptr, stamp->bytes, PROT_READ, MAP_SHARED, file.descriptor_, 0);
    if (map == MAP_FAILED)
    {
        return system_failure(path);
    }
    file.bytes_ = std::span(static_cast<const std::byte*>(map), stamp->bytes);
    file.stamp_ = *stamp;
    return file;
}

MappedFile::~MappedFile()
{
    if (!bytes_.empty())
    {
        ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
    }
    if (descriptor_ >= 0)
    {
        ::close(descriptor_);
    }
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(std::exchange(other.bytes_, {})),
      stamp_(other.stamp_)
{
}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept
{
    std::swap(descriptor_, other.descriptor_);
    std::swap(bytes_, other.bytes_);
    std::swap(stamp_, other.stamp_);
    return *this;
}

Result<void> MappedFile::read(std::uint64_t offset, std::span<std::byte> to) const
{
    while (!to.empty())
    {
        const ssize_t count =
            ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR)
        {
            continue;
        }
        if (count < 0)
        {
            return fail(ErrorCode::IoError, std::string("cannot read: ") + std::strerror(errno));
        }
        if (count == 0)
        {
            return fail(ErrorCode::Truncated, "the file ends too early", offset);
        }
        to = to.subspan(static_cast<std::size_t>(count));
        offset += static_cast<std::uint64_t>(count);
    }
    return {};
}

}  // namespace vsplit::net
