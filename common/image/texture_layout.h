#pragma once

#include "core/byte_reader.h"
#include "core/byte_writer.h"
#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::image {

inline constexpr std::uint32_t kMaxTextureSide = 32768;
inline constexpr std::uint8_t kMaxTextureLevels = 9;
inline constexpr std::uint8_t kMaxTextureLayers = 64;

/// Largest side of what group 0 shows, as a power of two; every further group doubles it.
inline constexpr unsigned kFirstGroupLog = 8;

/// What a reader has to know of an image to make the head of its code stream.
struct TextureHeader
{
    std::uint32_t width = 0;       ///< Pixels, 1 .. kMaxTextureSide.
    std::uint32_t height = 0;      ///< Pixels, 1 .. kMaxTextureSide.
    std::uint8_t channels = 3;     ///< 1 .. 4, as Raster has them.
    bool reversible = false;       ///< 5/3 wavelet without quantisation instead of 9/7.
    bool color_transform = false;  ///< The first three channels travel as luma and two chromas.
    std::uint8_t levels = 0;       ///< How often resolution is halved, 0 .. kMaxTextureLevels.
    std::uint8_t layers = 1;       ///< Quality layers, 1 .. kMaxTextureLayers.

    /// Memberwise equality.
    friend bool operator==(const TextureHeader&, const TextureHeader&) = default;
};

/// Appends a header's bytes. Precondition: its members are in their ranges.
/// Source: proto/TEXTURE_CHUNKS.md, "Image header".
void write_texture_header(const TextureHeader& header, ByteWriter& writer);

/// Reads a header. Errors: Truncated, BadChunk when a member is out of its range. Safe on untrusted
/// input.
[[nodiscard]] Result<TextureHeader> read_texture_header(ByteReader& reader);

/// One resolution of an image: its packets within a layer are consecutive.
struct TextureResolution
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    unsigned group = 0;
    std::uint32_t first_packet = 0;  ///< Packets of coarser resolutions, within a layer.
    std::uint32_t packets = 0;       ///< Channels times precincts.
};

/// Where the packets of an image lie: by layer, in it by resolution from the coarsest, in that by
/// channel, in that by precinct in rows. Source: ISO/IEC 15444-1, B.6, B.7 and B.12.1.1.
class TextureLayout
{
public:
    /// Computes it. Precondition: the header's members are in their ranges.
    explicit TextureLayout(const TextureHeader& header);

    /// Resolutions, the coarsest first.
    [[nodiscard]] const std::vector<TextureResolution>& resolutions() const { return resolutions_; }

    /// Packets of one layer.
    [[nodiscard]] std::uint32_t packets_per_layer() const { return packets_per_layer_; }

    /// Packets of all layers.
    [[nodiscard]] std::uint64_t packet_count() const { return packet_count_; }

    /// The group of a packet. Precondition: `packet` < packet_count().
    [[nodiscard]] unsigned group_of(std::uint64_t packet) const;

    /// One more than the last packet of the layer and group that hold a packet.
    /// Precondition: `packet` < packet_count().
    [[nodiscard]] std::uint64_t run_end(std::uint64_t packet) const;

    /// The finest resolution that belongs to a group or a coarser one.
    [[nodiscard]] std::size_t finest_resolution(unsigned group) const;

private:
    std::vector<TextureResolution> resolutions_;
    std::uint32_t packets_per_layer_ = 0;
    std::uint64_t packet_count_ = 0;
};

/// What the index says of a texture chunk (ChunkInfo::tag), so that a reader can leave it out.
struct TextureTag
{
    std::uint32_t image = 0;  ///< Index into Appearance::images.
    /// The chunk matters to whoever shows the image with a side longer than half of this many pixels.
    std::uint32_t side = 256;

    /// Memberwise equality.
    friend bool operator==(const TextureTag&, const TextureTag&) = default;
};

/// Packs image number and group: image << 12 | log2 of the largest side that the group serves; the eight bits
/// between are those of codec::picture_quality().
/// Preconditions: `image` < 2^19, `group` < 8.
[[nodiscard]] constexpr std::uint32_t texture_tag(std::uint32_t image, unsigned group)
{
    return image << 12U | (kFirstGroupLog + group);
}

/// Unpacks a tag; any value is accepted.
[[nodiscard]] constexpr TextureTag parse_texture_tag(std::uint32_t tag)
{
    return {.image = tag >> 12U, .side = 1U << (tag & 15U)};
}

/// True when a reader that shows images with sides of at most `max_size` pixels needs the chunk. Group
/// 0 is always needed.
[[nodiscard]] constexpr bool texture_chunk_wanted(std::uint32_t tag, std::uint32_t max_size)
{
    return (tag & 15U) <= kFirstGroupLog || parse_texture_tag(tag).side <= max_size;
}

}  // namespace vsplit::image
