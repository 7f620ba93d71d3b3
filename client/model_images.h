#pragma once

#include "codec/stream_info.h"
#include "core/result.h"
#include "image/raster.h"
#include "image/texture_decoder.h"
#include "scene/appearance.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::client {

/// An image that got sharper.
struct SharperImage
{
    std::uint32_t image = 0;
    Raster raster;
    std::chrono::duration<double, std::milli> decoding{};
};

/// Collects the materials of a model and the chunks of its images, and decodes images one at a time, so
/// that a frame never waits for more than one. Not thread safe. Safe on untrusted input.
class ModelImages
{
public:
    /// `texture_limit`: longest side of a decoded image, pixels; 0: no images.
    explicit ModelImages(std::uint32_t texture_limit) : limit_(texture_limit) {}

    /// Takes the contents of a chunk of kind Appearance or Texture; of images that nothing draws, or
    /// beyond the limit, nothing is kept. Errors: those of the decoders, with the chunk's offset.
    [[nodiscard]] Result<void> take(
        const codec::ChunkInfo& chunk, std::span<const std::byte> contents
    );

    /// The materials, once they came.
    [[nodiscard]] const Appearance* appearance() const
    {
        return appearance_ ? &*appearance_ : nullptr;
    }

    /// True when a texture chunk may be of use: always before the materials came.
    [[nodiscard]] bool wants(const codec::ChunkInfo& chunk) const;

    /// True when more of an image came since it was decoded.
    [[nodiscard]] bool has_sharper() const;

    /// Decodes the image that waits longest; nothing when none does.
    /// Errors: those of image::TextureDecoder::picture().
    [[nodiscard]] Result<std::optional<SharperImage>> decode_next();

    /// Bytes of coded images that are kept.
    [[nodiscard]] std::uint64_t coded_bytes() const;

private:
    struct Entry
    {
        image::TextureDecoder decoder;
        bool drawn = false;
        bool fed = false;  // Since it was decoded.
    };

    [[nodiscard]] Result<void> take_appearance(std::span<const std::byte> contents);
    [[nodiscard]] Result<void> take_texture(std::span<const std::byte> contents);

    std::uint32_t limit_ = 0;
    std::optional<Appearance> appearance_;
    std::vector<Entry> entries_;  // By image.
    std::size_t turn_ = 0;        // Where to look first.
};

}  // namespace vsplit::client
