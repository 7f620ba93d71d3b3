#pragma once

#include "codec/stream_info.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace vsplit::net {

/// A stream file that was validated and can be sent; immutable, shared between sessions.
struct ServedStream
{
    std::span<const std::byte> bytes;   ///< The whole file.
    codec::StreamInfo info;             ///< Header and index.
    std::uint64_t content_id = 0;       ///< wire::content_id() of the header.
    std::shared_ptr<const void> owner;  ///< Keeps `bytes` alive.
};

/// How sessions hold a stream.
using StreamPtr = std::shared_ptr<const ServedStream>;

}  // namespace vsplit::net
