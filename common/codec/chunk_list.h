#pragma once

#include "codec/stream_header_writer.h"
#include "codec/stream_info.h"
#include "core/byte_writer.h"
#include "core/crc32c.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace vsplit::codec {

/// The chunks of a stream while it is written. Not thread safe.
class ChunkList
{
public:
    /// Appends a chunk. `chunk`: what the index says of it, without its length; `bytes`: its contents.
    void add(ChunkInfo chunk, std::span<const std::byte> bytes)
    {
        chunk.bytes = static_cast<std::uint32_t>(bytes.size()) + proto::kChunkChecksumBytes;
        chunks_.push_back(chunk);
        payload_.write_bytes(bytes);
        payload_.write(crc32c(bytes));
        content_checksum_ =
            crc32c(payload_.view().last(proto::kChunkChecksumBytes), content_checksum_);
    }

    /// Length of all chunks.
    [[nodiscard]] std::size_t bytes() const { return payload_.size(); }

    /// What the index will say of the last chunk. Precondition: there is one.
    [[nodiscard]] const ChunkInfo& last() const { return chunks_.back(); }

    /// Writes header, index and chunks. `info`: what else the header says; `extent`: largest index per
    /// axis.
    [[nodiscard]] std::vector<std::byte> assemble(
        StreamInfo info, const std::array<std::int32_t, 3>& extent
    )
    {
        info.chunks = std::move(chunks_);
        info.content_checksum = content_checksum_;
        std::vector<std::byte> file = write_stream_header(info, extent);
        const auto payload = payload_.view();
        file.insert(file.end(), payload.begin(), payload.end());
        return file;
    }

private:
    std::vector<ChunkInfo> chunks_;
    ByteWriter payload_;
    std::uint32_t content_checksum_ = 0;
};

}  // namespace vsplit::codec
