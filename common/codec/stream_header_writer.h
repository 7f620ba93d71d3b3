#pragma once

#include "codec/stream_info.h"

#include <cstddef>
#include <vector>

namespace vsplit::codec {

/// Writes header and index.
/// `info`: grid, counts, content checksum, and for each chunk kind, codec, bytes, ends_level, vertices, faces and errors; its other members are ignored. `extent`: largest grid index of the mesh per axis (the
/// smallest is 0). Result: the bytes that parse_stream_info() reads; errors come back rounded up to
/// the next 1/32 octave. Source: proto/STREAM_FORMAT.md, "Header" and "Index".
[[nodiscard]] std::vector<std::byte> write_stream_header(
    const StreamInfo& info, const std::array<std::int32_t, 3>& extent
);

}  // namespace vsplit::codec
