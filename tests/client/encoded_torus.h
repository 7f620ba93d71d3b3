#pragma once

#include "codec/stream_info.h"

#include <cstddef>
#include <vector>

namespace vsplit::client {

/// A stream file and its header and index.
struct TestStream
{
    std::vector<std::byte> file;
    codec::StreamInfo info;
};

/// Encodes a bumpy torus of 3 456 vertices; always the same.
[[nodiscard]] const TestStream& encoded_torus();

}  // namespace vsplit::client
