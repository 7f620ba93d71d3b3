#pragma once

#include "codec/stream_parts.h"
#include "precompute/encode_mesh.h"
#include "precompute/textured_shapes.h"

#include <cstdint>
#include <vector>

namespace vsplit::test {

/// A stream with attributes and what went into it.
struct AttributedSample
{
    precompute::EncodeInput input;
    Bytes file;
    codec::StreamInfo info;
};

/// One attribute of every kind.
[[nodiscard]] std::vector<codec::AttributeInfo> every_kind();

/// Gives a shape values that follow its positions and jump between its groups.
[[nodiscard]] precompute::EncodeInput attributed(
    const TexturedShape& shape, const std::vector<codec::AttributeInfo>& attributes
);

/// Encodes; throws std::runtime_error when that fails.
[[nodiscard]] AttributedSample encode(
    const precompute::EncodeInput& input, const precompute::EncodeOptions& options = {}
);

/// A face by what it looks like: positions, group and numbers of its corners, the least corner first.
using FaceRow = std::vector<std::int32_t>;

/// All faces of what was encoded, sorted.
[[nodiscard]] std::vector<FaceRow> face_rows(const AttributedSample& sample);

/// All faces of the last level of a decoded stream, sorted.
[[nodiscard]] std::vector<FaceRow> face_rows(const codec::StreamInfo& info, const Decoded& decoded);

}  // namespace vsplit::test
