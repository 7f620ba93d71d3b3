#pragma once

#include "codec/stream_info.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vsplit::client {

/// Bytes of the stream file from `begin` to before `end`.
struct ByteRange
{
    std::uint64_t begin = 0;
    std::uint64_t end = 0;

    /// Memberwise equality.
    friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

/// Says whether a client has a use for an optional chunk.
using ChunkFilter = std::function<bool(const codec::ChunkInfo&)>;

/// Finds the chunks that need not be fetched, one range a chunk, ascending.
/// `wanted`: asked for optional chunks, apart from stitches, which belong to the shape; `end`: of the
/// prefix that will be decoded; `least_bytes`: neighbours that are shorter together are fetched all the
/// same, as asking for what follows them costs a round trip. Cost: linear in the index. Thread safe.
[[nodiscard]] std::vector<ByteRange> unwanted_chunks(
    const codec::StreamInfo& info,
    const ChunkFilter& wanted,
    std::uint64_t end,
    std::uint64_t least_bytes
);

}  // namespace vsplit::client
