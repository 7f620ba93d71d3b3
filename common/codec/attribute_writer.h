#pragma once

#include "codec/stream_encoder.h"
#include "codec/stream_header_writer.h"
#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Number of wedges of a mesh. `wedges`: by triangle those at its corners, 0 .. W - 1. Cost: linear.
[[nodiscard]] std::uint32_t count_wedges(std::span<const Triangle> wedges);

/// Codes the attributes of every level of a finished stream of geometry.
/// `file`: the stream; `plan`: what it was made of; `sources`: by vertex of the stream its vertex in the
/// plan. Result: the chunks, in order. Error: Internal when stream and plan contradict each other.
/// Cost: about 3 microseconds a vertex. Deterministic. Thread safe.
[[nodiscard]] Result<std::vector<ExtraChunk>> code_attributes(
    std::span<const std::byte> file, const StreamPlan& plan, std::span<const std::uint32_t> sources
);

}  // namespace vsplit::codec
