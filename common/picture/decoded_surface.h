#pragma once

#include "codec/stream_decoder.h"
#include "mesh/surface.h"

#include <span>
#include <vector>

namespace vsplit::picture {

/// Copies the attributes of a level that have values, with a value for every wedge.
/// `infos`: of the stream, as many as the level has attributes. Cost: linear.
[[nodiscard]] std::vector<SurfaceAttribute> decoded_attributes(
    std::span<const codec::AttributeInfo> infos, const codec::LevelAttributes& attributes
);

/// Copies what a decoder shows, with the attributes that have values, into a surface to draw. Cut
/// vertices are not stitched: levels are drawn as a client draws them.
/// Attributes are only taken over when they fit the triangles shown (see
/// StreamDecoder::attributes()). Precondition: decoder.vertices() > 0. Cost: linear.
[[nodiscard]] Surface decoded_surface(const codec::StreamDecoder& decoder);

}  // namespace vsplit::picture
