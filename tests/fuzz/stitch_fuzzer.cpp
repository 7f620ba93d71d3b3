// Decodes hostile stitches. The first byte is the number of vertices, the next ones their positions,
// four to a byte, so that many coincide.

#include "codec/entropy_coder.h"
#include "codec/stitch_coder.h"
#include "core/byte_writer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

using namespace vsplit;

using Positions = std::vector<std::array<std::int32_t, 3>>;

void require(bool holds)
{
    if (!holds)
    {
        std::abort();
    }
}

std::vector<std::byte> encode(const Positions& positions, std::vector<std::uint32_t> stitches)
{
    codec::BitEncoder bits;
    codec::code_stitches(
        bits, [&](std::uint32_t v) { return positions[v]; }, stitches
    );
    ByteWriter out;
    bits.finish(out);
    return out.take();
}

Result<std::vector<std::uint32_t>> decode(
    const Positions& positions, std::span<const std::byte> bytes
)
{
    codec::BitDecoder bits;
    VSPLIT_TRY(bits.start(bytes));
    std::vector<std::uint32_t> stitches(positions.size(), 0);
    codec::code_stitches(
        bits, [&](std::uint32_t v) { return positions[v]; }, stitches
    );
    for (std::uint32_t v = 0; v < stitches.size(); ++v)
    {
        require(stitches[v] <= v && stitches[stitches[v]] == stitches[v]);
        require(positions[stitches[v]] == positions[v]);
    }
    VSPLIT_TRY(bits.finish());
    return stitches;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto bytes = std::as_bytes(std::span(data, size));
    if (bytes.empty())
    {
        return 0;
    }
    const auto count = static_cast<std::size_t>(bytes[0]);
    const std::size_t position_bytes = (count + 3) / 4;
    if (bytes.size() < 1 + position_bytes)
    {
        return 0;
    }
    Positions positions;
    for (std::size_t v = 0; v < count; ++v)
    {
        const auto four = static_cast<unsigned>(bytes[1 + v / 4]);
        positions.push_back({static_cast<std::int32_t>(four >> (2 * (v % 4)) & 3U), 0, 0});
    }
    const auto stitches = decode(positions, bytes.subspan(1 + position_bytes));
    if (stitches)
    {
        // What was understood can be said again.
        const auto again = decode(positions, encode(positions, *stitches));
        require(again.has_value() && *again == *stitches);
    }
    return 0;
}
