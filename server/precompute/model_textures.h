#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "image/texture_encoder.h"
#include "precompute/encode_model.h"

#include <functional>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// The images of a model, decoded and coded.
struct ModelTextures
{
    std::vector<Raster> rasters;  ///< As the source has them.
    std::vector<image::EncodedTexture>
        encoded;  ///< One an image; without chunks when none uses it.
};

/// Codes the images that a model's materials use, and puts the size that is coded into the appearance.
/// `images`: one for each of appearance.images; `progress`: gets the share done.
/// Errors: those of image::read_image() and image::encode_texture(), with the image's name.
[[nodiscard]] Result<ModelTextures> encode_textures(
    Appearance& appearance,
    std::span<const SourceImage> images,
    const ImageOptions& options,
    const std::function<void(double)>& progress
);

/// Puts a model's appearance and its images into a finished stream of its shape, in the order in which the
/// pictures of the model get better soonest. `file`: the stream; `original`: what it was made of.
/// Errors: those of order_chunks(), scene::encode_appearance() and codec::insert_chunks().
[[nodiscard]] Result<std::vector<std::byte>> insert_appearance(
    std::span<const std::byte> file,
    const Surface& original,
    const Appearance& appearance,
    const ModelTextures& textures
);

}  // namespace vsplit::precompute
