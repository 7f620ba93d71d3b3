#pragma once

#include "core/result.h"
#include "precompute/code_attributes.h"
#include "precompute/encode_mesh.h"
#include "precompute/repair_surface.h"
#include "precompute/source_model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vsplit::precompute {

/// How images are coded; see image::TextureOptions.
struct ImageOptions
{
    std::uint32_t max_size = 2048;  ///< Longest side, pixels; larger images are scaled down.
    double psnr = 40.0;             ///< Quality, decibels.
    bool lossless = false;
};

/// Choices of an encode of a model.
struct ModelOptions
{
    EncodeOptions mesh;
    AttributeBits bits{.tex_coord = 0};  ///< 0 for texture coordinates: choose_tex_coord_bits().
    ImageOptions images;
};

/// A repaired model.
struct RepairedModel
{
    RepairedSurface surface;
    Appearance appearance;
    std::vector<SourceImage> images;  ///< One for each of Appearance::images.
};

/// A finished stream and what it took.
struct EncodedModel
{
    EncodedMesh mesh;               ///< The whole stream, images included.
    std::uint64_t image_bytes = 0;  ///< Of its texture chunks.
    double image_seconds = 0.0;     ///< For coding and ordering images.
};

/// Encodes a model with all that lies on it. Images come where, for their bytes, they make the pictures of
/// the model better than finer levels do; see order_chunks().
/// Errors: those of encode_surface() and make_encode_input(); those of image::read_image() with the image's
/// name. Cost: as encode_surface(); about two seconds a megapixel of images. Deterministic. Thread safe.
[[nodiscard]] Result<EncodedModel> encode_model(
    RepairedModel&& model, const ModelOptions& options, const ProgressSink& progress = {}
);

}  // namespace vsplit::precompute
