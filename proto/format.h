#pragma once

#include <cstddef>
#include <cstdint>

/// Constants of the stream file, version 0 (proto/STREAM_FORMAT.md). A test compares them with the
/// tables of that document.
namespace vsplit::proto {

inline constexpr std::uint32_t kStreamMagic = 0x54505356;  ///< "VSPT", little-endian.
inline constexpr std::uint8_t kStreamMajor = 0;
inline constexpr std::uint8_t kStreamMinor = 5;

/// Bytes from which the header's length is known: magic, version, and a length of four bytes.
inline constexpr std::size_t kHeaderProbeBytes = 9;

inline constexpr int kMinPositionBits = 8;
inline constexpr int kMaxPositionBits = 20;
inline constexpr std::uint32_t kMaxVertices = 1U << 28;
inline constexpr std::uint32_t kMaxFaces = (1U << 29) - 2;
inline constexpr std::uint32_t kMaxChunks = 1U << 20;
inline constexpr std::uint32_t kMaxLevels = 1024;
inline constexpr std::uint32_t kMaxAttributes = 16;
inline constexpr std::uint32_t kMaxHeaderBytes = 1U << 24;

/// Chunks are cut so that they stay near this size; a reader accepts larger ones within its limits.
inline constexpr std::uint32_t kTargetChunkBytes = 64U * 1024U;

/// Length of the CRC-32C that ends the header and every chunk and is part of their length.
inline constexpr std::uint32_t kChunkChecksumBytes = 4;

/// Added to the position bits when the grid's four numbers are binary32 instead of binary64.
inline constexpr std::uint8_t kSinglePrecisionGrid = 0x80;

/// Added to the position bits when a table of attributes follows.
inline constexpr std::uint8_t kHasAttributes = 0x20;

/// Added to an attribute's kind when colours are coded as red, green and blue.
inline constexpr std::uint8_t kRgbColor = 0x08;

/// What a chunk holds. Kinds below 64 are required: a reader that does not know one refuses the
/// stream; kinds from 64 on are optional and may be skipped by their length.
enum class ChunkKind : std::uint8_t
{
    Base = 0,         ///< The base mesh.
    Batch = 1,        ///< Vertex splits that refine the mesh.
    Growth = 2,       ///< A part of the complete mesh, grown over the coarse one.
    Parts = 3,        ///< Components that show from a level on.
    Stitch = 64,      ///< Which vertices of the last level are one vertex in the source mesh.
    Attributes = 65,  ///< Attributes of what a level added.
    Appearance = 66,  ///< Materials, groups of faces, descriptions of images.
    Texture = 67,     ///< A part of an image.
};

inline constexpr std::uint8_t kFirstOptionalChunkKind = 64;

/// Codecs of attributes.
inline constexpr std::uint8_t kValuesCodec = 0;    ///< Wedges, groups, values of a level.
inline constexpr std::uint8_t kNormalsCodec = 1;   ///< Normals of the last level.
inline constexpr std::uint8_t kLateBitsCodec = 2;  ///< Bits that values of the last level lack.

/// Codecs of the base mesh.
inline constexpr std::uint8_t kDracoBaseCodec = 0;  ///< A Draco mesh.
inline constexpr std::uint8_t kSmallBaseCodec = 1;  ///< Our own, without tables, for small ones.

}  // namespace vsplit::proto
