#pragma once

#include "core/result.h"
#include "image/code_stream.h"
#include "image/raster.h"
#include "image/texture_encoder.h"
#include "image/texture_layout.h"

#include <span>
#include <vector>

namespace vsplit::image {

/// How an image is going to be coded.
struct TexturePlan
{
    TextureHeader header;            ///< Without the number of layers.
    std::vector<double> layer_ends;  ///< Bytes of packets; the last 0 for all that there is.
};

/// Chooses how to code an image: the wavelet by trying both (9/7 suits pictures, 5/3 suits drawings,
/// whose edges it blurs less), the length of all layers so that the quality is as wanted.
/// `raster`: scaled down already. Errors: Internal. Cost: two encodings and some ten decodings each.
[[nodiscard]] Result<TexturePlan> plan_texture(const Raster& raster, const TextureOptions& options);

/// Codes an image in layers and takes the code stream apart. `header`: gets the number of layers;
/// `layer_ends`: as TexturePlan has them. Errors: Internal.
[[nodiscard]] Result<CodedPackets> encode_layers(
    const Raster& raster, TextureHeader& header, std::span<const double> layer_ends
);

/// Mean of the squared differences of two images of the same size and channels.
[[nodiscard]] double mean_squared_error(const Raster& a, const Raster& b);

}  // namespace vsplit::image
