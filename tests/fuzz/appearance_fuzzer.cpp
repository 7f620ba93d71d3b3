// Feeds noise to the reader of appearance chunks; what it accepts must survive being written again.

#include "scene/appearance_chunk.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace vsplit::scene;
    const auto read = decode_appearance(std::as_bytes(std::span(data, size)));
    if (!read)
    {
        return 0;
    }
    const auto written = encode_appearance(*read);
    if (!written || decode_appearance(*written) != *read)
    {
        std::abort();
    }
    return 0;
}
