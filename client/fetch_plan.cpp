#include "fetch_plan.h"

namespace vsplit::client {
namespace {

bool is_unwanted(const codec::ChunkInfo& chunk, const ChunkFilter& wanted)
{
    const bool optional = static_cast<std::uint8_t>(chunk.kind) >= proto::kFirstOptionalChunkKind;
    return optional && chunk.kind != proto::ChunkKind::Stitch && !wanted(chunk);
}

}  // namespace

std::vector<ByteRange> unwanted_chunks(
    const codec::StreamInfo& info,
    const ChunkFilter& wanted,
    std::uint64_t end,
    std::uint64_t least_bytes
)
{
    std::vector<ByteRange> result;
    std::size_t run = 0;  // Where the neighbours that are looked at begin in the result.
    const auto end_run = [&] {
        if (run < result.size() && result.back().end - result[run].begin < least_bytes)
        {
            result.resize(run);
        }
        run = result.size();
    };
    for (const codec::ChunkInfo& chunk : info.chunks)
    {
        if (chunk.offset >= end)
        {
            break;
        }
        if (is_unwanted(chunk, wanted))
        {
            result.push_back({chunk.offset, chunk.offset + chunk.bytes});
        }
        else
        {
            end_run();
        }
    }
    end_run();
    return result;
}

}  // namespace vsplit::client
