#pragma once

#include "core/result.h"
#include "net/mapped_file.h"
#include "net/served_stream.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

namespace vsplit::net {

/// Opens stream files and shares them between sessions. A file is mapped once while anyone uses it;
/// its chunk checksums are verified once per state of the file (path, inode, size, time). Thread safe;
/// two threads that open the same new file may both read it, one of the maps is kept.
class StreamStore
{
public:
    /// `limits`: files beyond them are refused.
    explicit StreamStore(const codec::DecodeLimits& limits = {}) : limits_(limits) {}

    /// Opens and validates a stream file.
    /// `path`: absolute, canonical. Errors: those of MappedFile::open and codec::parse_stream_info;
    /// Truncated and TrailingBytes when the length is not the one of the index, BadChecksum.
    /// Cost: reads the file once when its state is new. Safe on untrusted files.
    [[nodiscard]] Result<StreamPtr> open(const std::filesystem::path& path);

private:
    struct Entry
    {
        FileStamp stamp;
        std::weak_ptr<const ServedStream> stream;
    };

    [[nodiscard]] StreamPtr find(const std::filesystem::path& path, const FileStamp& stamp);
    [[nodiscard]] bool is_verified(const std::filesystem::path& path, const FileStamp& stamp);
    [[nodiscard]] StreamPtr keep(
        const std::filesystem::path& path, const FileStamp& stamp, StreamPtr stream
    );

    codec::DecodeLimits limits_;
    std::mutex mutex_;
    std::map<std::filesystem::path, Entry> entries_;
};

}  // namespace vsplit::net
