#pragma once

#include "codec/stream_decoder.h"
#include "mesh/surface.h"

namespace vsplit::picture {

/// Copies what a decoder shows, with the attributes that have values, into a surface to draw. Cut
/// vertices are not stitched: levels are drawn as a client draws them.
/// Attributes are only taken over when they fit the triangles shown (see
/// StreamDecoder::attributes()). Precondition: decoder.vertices() > 0. Cost: linear.
[[nodiscard]] Surface decoded_surface(const codec::StreamDecoder& decoder);

}  // namespace vsplit::picture
