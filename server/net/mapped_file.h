#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace vsplit::net {

/// What tells one state of a file from another without reading it.
struct FileStamp
{
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    std::uint64_t bytes = 0;
    std::int64_t modified_ns = 0;  ///< Time of the last change, nanoseconds since the epoch.

    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Reads the stamp of a regular file; symbolic links are followed.
/// Errors: NotFound, IoError (also when it is not a regular file). Thread safe.
[[nodiscard]] Result<FileStamp> stamp_file(const std::filesystem::path& path);

/// A regular file mapped read-only into memory; unmapped by the destructor. Read it through read() to
/// validate it: that reports an error where touching the map of a file that was cut meanwhile would
/// end the program. Handing the map to the kernel (send) is safe in that case. Thread safe.
class MappedFile
{
public:
    /// Maps a whole file. `path`: not a symbolic link. Errors: NotFound, IoError,
    /// Truncated when the file is empty.
    [[nodiscard]] static Result<MappedFile> open(const std::filesystem::path& path);

    /// Unmaps and closes the file.
    ~MappedFile();

    /// Takes the map over; `other` is left without one.
    MappedFile(MappedFile&& other) noexcept;

    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// Exchanges the maps.
    MappedFile& operator=(MappedFile&& other) noexcept;

    /// The bytes of the file; valid while this object lives.
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

    /// The state in which the file was opened.
    [[nodiscard]] const FileStamp& stamp() const { return stamp_; }

    /// Copies `to.size()` bytes of the file from `offset` on. Error: Truncated, IoError.
    [[nodiscard]] Result<void> read(std::uint64_t offset, std::span<std::byte> to) const;

private:
    explicit MappedFile(int descriptor) : descriptor_(descriptor) {}

    int descriptor_ = -1;
    std::span<const std::byte> bytes_;
    FileStamp stamp_;
};

}  // namespace vsplit::net
