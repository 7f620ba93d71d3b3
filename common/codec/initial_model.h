#pragma once

#include "codec/connectivity_model.h"
#include "codec/geometry_coder.h"
#include "codec/refinement_coder.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Everything that is learned while a stream is coded.
struct LearnedModel
{
    ConnectivityModel connectivity;
    GeometryModel geometry;
    RefinementModel refinement;
};

/// Returns the state in which every stream starts: what coding typical meshes teaches, so that small
/// meshes and low rates need not pay for learning it again. Cost: about ten thousand table entries.
/// Source: proto/STREAM_FORMAT.md, "Initial state".
[[nodiscard]] LearnedModel initial_model();

/// Packs a model into the bytes from which initial_model() unpacks: one signed byte a weight, in 1/32
/// nat; one byte an adaptive bit, its probability in 1/256, 0 when it was never used.
/// `models`: what several meshes taught, averaged; at least one.
[[nodiscard]] std::vector<std::uint8_t> pack_model(std::span<const LearnedModel> models);

}  // namespace vsplit::codec
