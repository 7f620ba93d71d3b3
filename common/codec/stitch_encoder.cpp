#include "codec/stitch_encoder.h"

#include "codec/entropy_coder.h"
#include "codec/stitch_coder.h"
#include "core/byte_writer.h"

#include <algorithm>
#include <limits>

namespace vsplit::codec {

std::vector<std::byte> encode_stitches(
    std::span<const std::uint32_t> stitches,
    std::span<const std::uint32_t> sources,
    std::span<const std::array<std::int32_t, 3>> positions
)
{
    // By class of the plan the first vertex of the stream that belongs to it.
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> first(sources.size(), kNone);
    std::vector<std::uint32_t> of_stream(sources.size());
    for (std::uint32_t v = 0; v < sources.size(); ++v)
    {
        std::uint32_t& representative = first[stitches[sources[v]]];
        representative = std::min(representative, v);
        of_stream[v] = representative;
    }
    BitEncoder bits;
    code_stitches(
        bits, [&](std::uint32_t v) { return positions[sources[v]]; }, of_stream
    );
    ByteWriter chunk;
    bits.finish(chunk);
    const auto view = chunk.view();
    return {view.begin(), view.end()};
}

}  // namespace vsplit::codec
