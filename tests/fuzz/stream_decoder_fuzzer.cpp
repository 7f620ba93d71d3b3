// Decodes hostile streams: as they are, and with the checksums made right, because whoever makes a
// stream also makes its checksums. The last byte chooses how many bytes are fed at a time.
// Seeds: tests/golden.

#include "codec/stream_parts.h"
#include "fuzz/decoder_check.h"

#include <cstddef>
#include <cstdint>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto bytes = std::as_bytes(std::span(data, size));
    const std::size_t piece = bytes.empty() ? 1 : 1 + static_cast<std::size_t>(bytes.back()) * 8;
    vsplit::fuzz::check_stream(bytes, piece);
    vsplit::test::Bytes repaired(bytes.begin(), bytes.end());
    vsplit::test::repair_checksums(repaired);
    vsplit::fuzz::check_stream(repaired, piece);
    return 0;
}
