#pragma once

#include "codec/stream_decoder.h"
#include "core/result.h"
#include "image/texture_decoder.h"
#include "mesh/surface.h"
#include "scene/appearance.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::tools {

/// Collects what a stream says of materials and images while it is decoded. Not thread safe. Safe on
/// untrusted input.
class DecodedModel
{
public:
    /// Takes what a step passed over. Errors: those of the decoders of such chunks.
    [[nodiscard]] Result<void> take(const codec::Step& step);

    /// Materials, groups and images; empty when the stream has none.
    [[nodiscard]] const Appearance& appearance() const { return appearance_; }

    /// Decodes the images as far as they came and makes files of them: JPEG, PNG where that would harm
    /// (alpha, directions, exact images). One for each of appearance().images, empty where nothing came.
    /// Errors: those of image::TextureDecoder::picture() and of writing image files.
    [[nodiscard]] Result<std::vector<SourceImage>> images() const;

private:
    Appearance appearance_;
    std::vector<image::TextureDecoder> textures_;  ///< By image.
};

/// Copies what a decoder shows, model units; at the complete level cut vertices are stitched.
[[nodiscard]] Surface stitched_surface(const codec::StreamDecoder& decoder);

}  // namespace vsplit::tools
