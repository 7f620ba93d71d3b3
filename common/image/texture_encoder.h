#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "image/texture_layout.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::image {

/// How to code an image.
struct TextureOptions
{
    std::uint32_t image = 0;        ///< Its index in Appearance::images, below 2^19.
    std::uint32_t max_size = 2048;  ///< Longest side, pixels; larger images are scaled down.
    double psnr = 40.0;             ///< Quality of all chunks together, decibels.
    /// Quality wanted as long as an image stays below the next number: it costs little, and whoever has
    /// enough stops before.
    double cheap_psnr = 64.0;
    double cheap_bits_per_pixel = 0.8;
    double small_bits_per_pixel = 1.2;  ///< The same for images below small_bytes.
    std::uint32_t small_bytes = 48000;  ///< Bytes that no one minds.
    std::uint64_t cheap_bytes = std::uint64_t{1}
                                << 40U;  ///< And below this many bytes, or small_bytes.
    std::uint32_t exact_bytes = 24000;   ///< Images that take no more without loss are coded so.
    bool lossless = false;       ///< Exact (after scaling down); `psnr` does not count then.
    bool is_normal_map = false;  ///< Channels are directions, not a colour.
    std::uint32_t preview_bytes = 1400;  ///< About the length of the first chunk.
    double layer_ratio = 1.25;  ///< About how much longer each quality layer makes the prefix.
    /// Measure TextureChunk::squared_error after every chunk, not only after every layer and between
    /// those interpolate; several times slower for large images.
    bool measure_every_chunk = false;
};

/// A part of an image.
struct TextureChunk
{
    unsigned layer = 0;              ///< First quality layer that it holds something of.
    unsigned group = 0;              ///< Coarsest group of resolutions that it holds something of.
    std::uint32_t tag = 0;           ///< texture_tag() of image and group.
    std::vector<std::byte> payload;  ///< Without the checksum.
    /// Mean of the squared difference to the (scaled) source, over pixels and channels, 0 .. 65025, when
    /// this chunk and all before it have come.
    double squared_error = 0.0;
};

/// An image, coded.
struct EncodedTexture
{
    ImageInfo info;                    ///< Size and channels of what is coded; no name.
    std::vector<TextureChunk> chunks;  ///< In the order in which they must come.
};

/// Codes an image as chunks of which every prefix shows it as well as its bytes allow.
/// `raster`: 1 .. 4 channels. Preconditions: its pixels are as many as its size says, options in range.
/// Errors: InputTooLarge for sides above kMaxTextureSide, Internal. Same input, same bytes.
/// Cost: some 2 s a megapixel, mostly decoding prefixes.
/// Source: proto/TEXTURE_CHUNKS.md.
[[nodiscard]] Result<EncodedTexture> encode_texture(
    const Raster& raster, const TextureOptions& options = {}
);

}  // namespace vsplit::image
