#pragma once

#include "core/result.h"
#include "picture_judge.h"

#include <cstddef>
#include <span>

namespace vsplit::bench {

/// What a client shows of the first bytes of a stream.
struct ShownPrefix
{
    std::uint64_t bytes = 0;  ///< Of the chunks that were complete, the header included.
    ShownModel model;         ///< Without triangles when the base mesh was not complete.
};

/// Decodes the complete chunks of a prefix: the last level with its attributes, and what has come of
/// the images. `prefix`: any first bytes of a stream. Errors: those of StreamDecoder, and BadChunk for
/// malformed image and appearance chunks.
[[nodiscard]] Result<ShownPrefix> show_prefix(std::span<const std::byte> prefix);

}  // namespace vsplit::bench
