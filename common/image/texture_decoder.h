#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "image/texture_layout.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace vsplit::image {

/// Bounds that a reader sets before it trusts texture chunks.
struct TextureLimits
{
    /// Longest side that is ever shown, pixels: what finer resolutions need is checked, not kept.
    std::uint32_t max_size = kMaxTextureSide;
    std::uint64_t max_pixels = std::uint64_t{1} << 26U;       ///< Of a picture.
    std::uint64_t max_coded_bytes = std::uint64_t{1} << 28U;  ///< Kept at once.
};

/// Reads which image a texture chunk is about, to find the decoder that it belongs to.
/// `payload`: the chunk without its checksum. Errors: Truncated, BadChunk. Safe on untrusted input.
[[nodiscard]] Result<std::uint32_t> texture_chunk_image(std::span<const std::byte> payload);

/// Collects the chunks of one image and shows what has come of it. Not thread safe. Safe on untrusted
/// input. Source: proto/TEXTURE_CHUNKS.md.
class TextureDecoder
{
public:
    /// Starts with nothing.
    explicit TextureDecoder(TextureLimits limits = {}) : limits_(limits) {}

    /// Takes a chunk. The first chunk of the image comes first; later ones may be left out but not
    /// come in another order. After a gap only what does not build on the missing ones is used.
    /// `payload`: the chunk without its checksum.
    /// Errors: Truncated, BadChunk, LimitExceeded; the decoder is then as it was before.
    /// Cost: linear in the payload, and once in the packets of a layer.
    [[nodiscard]] Result<void> feed(std::span<const std::byte> payload);

    /// The image's description; nothing before its first chunk.
    [[nodiscard]] const std::optional<TextureHeader>& header() const { return header_; }

    /// Bytes of packets that are kept.
    [[nodiscard]] std::uint64_t coded_bytes() const { return coded_bytes_; }

    /// True when nothing is missing that limits.max_size shows.
    [[nodiscard]] bool complete() const;

    /// Decodes what has come.
    /// `max_size`: longest side, pixels, at least 1; the size of the result depends on it and on the
    /// image only: its size halved (rounded up) until it fits.
    /// Errors: Truncated when nothing has come, LimitExceeded, BadChunk when packets are malformed.
    /// Cost: linear in the result's pixels and in the packets; memory at most texture_decode_bytes().
    [[nodiscard]] Result<Raster> picture(std::uint32_t max_size) const;

private:
    /// Packets of one layer and one group, or a part of them.
    struct Run
    {
        std::uint64_t first = 0;
        std::uint64_t count = 0;
        std::vector<std::byte> bytes;  ///< Empty: all are kUntouchedPacket.
    };

    struct Chunk
    {
        std::uint32_t image = 0;
        std::optional<TextureHeader> header;
        std::vector<Run> runs;
    };

    [[nodiscard]] Result<Chunk> parse(std::span<const std::byte> payload) const;
    void take(Run run);
    [[nodiscard]] bool builds_on_what_came(const Run& run) const;
    [[nodiscard]] std::vector<std::byte> code_stream(std::size_t resolution) const;

    TextureLimits limits_;
    std::uint32_t image_ = 0;
    std::optional<TextureHeader> header_;
    std::optional<TextureLayout> layout_;
    std::vector<std::uint8_t> layers_;  ///< By packet of a layer: how many layers of it came.
    std::vector<Run> runs_;
    std::uint64_t next_packet_ = 0;
    std::uint64_t coded_bytes_ = 0;
};

/// Returns an upper bound of the heap that TextureDecoder::picture() uses while it runs, its result
/// included, apart from `coded_bytes` that it has collected.
/// `info`: size and channels of the image; `max_size`: as picture() takes it.
[[nodiscard]] std::uint64_t texture_decode_bytes(
    const ImageInfo& info, std::uint32_t max_size, std::uint64_t coded_bytes = 0
);

}  // namespace vsplit::image
