#pragma once

#include "image/code_stream.h"
#include "image/texture_encoder.h"

#include <vector>

namespace vsplit::image {

/// Cuts the packets of an image into chunks: at the borders of groups and layers, and within them
/// where a chunk would become too long; runs too short for a chunk share one, whose tag is that of the
/// coarsest. Squared errors stay 0. Precondition: as many packets as the header says.
/// Source: proto/TEXTURE_CHUNKS.md.
[[nodiscard]] std::vector<TextureChunk> cut_chunks(
    const CodedPackets& coded, const TextureHeader& header, std::uint32_t image
);

}  // namespace vsplit::image
