#include "net/stream_store.h"

#include "core/crc32c.h"
#include "wire/message.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::net {
namespace {

/// More remembered files than this and the unused ones are forgotten.
constexpr std::size_t kMaxEntries = 4096;
constexpr std::size_t kReadBlockBytes = std::size_t{64} * 1024;

Result<std::vector<std::byte>> read_header(
    const MappedFile& file, const codec::DecodeLimits& limits
)
{
    std::vector<std::byte> header(std::min(codec::header_probe_bytes(), file.bytes().size()));
    VSPLIT_TRY(file.read(0, header));
    const auto length = codec::parse_header_bytes(header, limits);
    VSPLIT_TRY(length);
    header.resize(std::min<std::size_t>(*length, file.bytes().size()));
    VSPLIT_TRY(file.read(0, header));
    return header;
}

Result<void> check_length(const MappedFile& file, const codec::StreamInfo& info)
{
    const std::uint64_t bytes = file.bytes().size();
    if (bytes < info.file_bytes)
    {
        return fail(ErrorCode::Truncated, "the stream file is cut", bytes);
    }
    if (bytes > info.file_bytes)
    {
        return fail(ErrorCode::TrailingBytes, "bytes follow the stream", info.file_bytes);
    }
    return {};
}

Result<void> check_chunk(const MappedFile& file, const codec::ChunkInfo& chunk)
{
    std::array<std::byte, kReadBlockBytes> block{};
    std::uint32_t checksum = 0;
    for (std::uint64_t done = 0; done < chunk.bytes;)
    {
        const auto count = std::min<std::uint64_t>(chunk.bytes - done, block.size());
        const auto part = std::span(block).first(count);
        VSPLIT_TRY(file.read(chunk.offset + done, part));
        checksum = crc32c(part, checksum);
        done += count;
    }
    if (checksum != kCrc32cResidue)
    {
        return fail(ErrorCode::BadChecksum, "a chunk is damaged", chunk.offset);
    }
    return {};
}

}  // namespace

Result<StreamPtr> StreamStore::open(const std::filesystem::path& path)
{
    const auto stamp = stamp_file(path);
    VSPLIT_TRY(stamp);
    if (auto stream = find(path, *stamp))
    {
        return stream;
    }
    auto opened = MappedFile::open(path);
    VSPLIT_TRY(opened);
    const auto file = std::make_shared<const MappedFile>(std::move(*opened));
    const auto header = read_header(*file, limits_);
    VSPLIT_TRY(header);
    auto info = codec::parse_stream_info(*header, limits_);
    VSPLIT_TRY(info);
    VSPLIT_TRY(check_length(*file, *info));
    if (!is_verified(path, file->stamp()))
    {
        for (const codec::ChunkInfo& chunk : info->chunks)
        {
            VSPLIT_TRY(check_chunk(*file, chunk));
        }
    }
    const std::uint64_t id = wire::content_id(*header);
    return keep(
        path,
        file->stamp(),
        std::make_shared<const ServedStream>(ServedStream{file->bytes(), std::move(*info), id, file}
        )
    );
}

StreamPtr StreamStore::find(const std::filesystem::path& path, const FileStamp& stamp)
{
    const std::lock_guard lock(mutex_);
    const auto entry = entries_.find(path);
    const bool same = entry != entries_.end() && entry->second.stamp == stamp;
    return same ? entry->second.stream.lock() : nullptr;
}

bool StreamStore::is_verified(const std::filesystem::path& path, const FileStamp& stamp)
{
    const std::lock_guard lock(mutex_);
    const auto entry = entries_.find(path);
    return entry != entries_.end() && entry->second.stamp == stamp;
}

StreamPtr StreamStore::keep(
    const std::filesystem::path& path, const FileStamp& stamp, StreamPtr stream
)
{
    const std::lock_guard lock(mutex_);
    if (entries_.size() >= kMaxEntries)
    {
        std::erase_if(entries_, [](const auto& entry) { return entry.second.stream.expired(); });
    }
    Entry& entry = entries_[path];
    const StreamPtr present = entry.stamp == stamp ? entry.stream.lock() : nullptr;
    if (present)
    {
        return present;
    }
    entry = Entry{stamp, stream};
    return stream;
}

}  // namespace vsplit::net
