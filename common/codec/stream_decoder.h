#pragma once

#include "codec/level_attributes.h"
#include "codec/level_mesh.h"
#include "codec/stream_info.h"
#include "codec/triangle_updates.h"
#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vsplit::codec {

/// What one StreamDecoder::step() did.
enum class StepKind : std::uint8_t
{
    NeedBytes,     ///< Nothing: the next chunk is not complete; feed more.
    Header,        ///< Header and index are known now.
    Chunk,         ///< One chunk was applied; the mesh is valid and finer.
    SkippedChunk,  ///< An optional chunk was passed over or changed no triangle.
    Complete,      ///< Nothing: every chunk of the stream was applied.
};

/// How the mesh changed in one step; for keeping GPU buffers up to date.
struct Step
{
    StepKind kind = StepKind::NeedBytes;
    bool level_complete = false;         ///< True when a level of the index is reached.
    std::uint32_t level = 0;             ///< The level being shown (the last one completed).
    std::uint32_t chunk_bytes = 0;       ///< Bytes of the chunk that was applied.
    std::uint32_t first_new_vertex = 0;  ///< Vertices from here on are new.
    /// Vertices from here on have new positions: equals first_new_vertex, or 0 when known positions
    /// gained precision.
    std::uint32_t first_moved_vertex = 0;
    std::uint32_t vertices = 0;  ///< Vertices of the mesh now.
    std::uint32_t faces = 0;     ///< Triangles of the mesh now.
    TriangleUpdates triangles;   ///< Valid until the next step(), and while the decoder stays.
    /// True when every triangle is another one: read them all with write_triangles().
    bool triangles_replaced = false;
    /// True when the attributes of the level being shown are complete with this chunk; see
    /// StreamDecoder::attributes().
    bool attributes_complete = false;
    const ChunkInfo* chunk = nullptr;  ///< The chunk that was applied or passed over, of info().
    /// What an optional chunk holds, checked against its checksum; valid until the next feed(),
    /// step() or skip(). Empty for others, and for a chunk that skip() passed over.
    std::span<const std::byte> contents;
};

/// Turns the bytes of a stream, as they come, into a mesh that gets finer. Vertices are appended and
/// keep their index; triangles keep their slot. After an error every further call gives the same
/// error and the mesh stays readable: the last good one where a checksum failed; where a chunk
/// contradicts itself, a valid one that may already hold a part of it. The limits
/// are checked when the header is known; memory is taken then for the longest chunk and, when the base
/// is decoded, once for all of the mesh. Not thread safe. Safe on untrusted input. Never throws on data. Source: proto/STREAM_FORMAT.md.
class StreamDecoder
{
public:
    /// Prepares a decoder that obeys `limits`.
    explicit StreamDecoder(const DecodeLimits& limits = {});
    ~StreamDecoder();
    StreamDecoder(StreamDecoder&&) noexcept;
    StreamDecoder& operator=(StreamDecoder&&) noexcept;

    /// Takes the next bytes of the stream; does not decode. At most wanted_bytes() are taken.
    /// Returns how many were taken: feed the rest after step(). Error: the first error of step().
    [[nodiscard]] Result<std::size_t> feed(std::span<const std::byte> bytes);

    /// Bytes that complete the header or the next chunk; 0 when step() has work or all is done.
    [[nodiscard]] std::size_t wanted_bytes() const;

    /// Does the next piece of work: the header, or one chunk.
    /// Errors: those of parse_stream_info; BadChecksum, BadChunk, LimitExceeded with the chunk's offset.
    [[nodiscard]] Result<Step> step();

    /// The chunk that step() will decode next; nullptr before the header and after the last chunk.
    [[nodiscard]] const ChunkInfo* next_chunk() const;

    /// Passes over the next chunk, whose bytes are left out of what is fed.
    /// Precondition: next_chunk() is of an optional kind and nothing of it was fed.
    Step skip();

    /// Header and index; nullptr before the header was decoded.
    [[nodiscard]] const StreamInfo* info() const;

    /// Bytes of the stream that were decoded so far (a chunk boundary): the offset to resume from
    /// a transfer whose undecoded bytes are lost.
    [[nodiscard]] std::uint64_t decoded_bytes() const;

    /// Bytes of the stream taken so far; the offset to resume a transfer from.
    [[nodiscard]] std::uint64_t received_bytes() const;

    /// True when every chunk was applied.
    [[nodiscard]] bool complete() const;

    /// The level being shown; 0 is the base mesh. Only meaningful once vertices() > 0.
    [[nodiscard]] std::uint32_t level() const;

    /// Vertices of the mesh now; 0 before the base mesh.
    [[nodiscard]] std::uint32_t vertices() const;

    /// Triangles of the mesh now.
    [[nodiscard]] std::uint32_t faces() const;

    /// Bits of precision that positions still lack (the level's shift).
    [[nodiscard]] int shift() const;

    /// Writes the positions of `count` vertices from `first` on, model units, x y z each.
    /// Precondition: first + count <= vertices(), out.size() >= 3 * count.
    void write_positions(std::uint32_t first, std::uint32_t count, std::span<float> out) const;

    /// Writes the grid position of one vertex in units of 2^shift() cells.
    [[nodiscard]] std::array<std::int32_t, 3> grid_position(std::uint32_t vertex) const;

    /// Writes all triangles in slot order. Precondition: out.size() >= faces().
    void write_triangles(std::span<Triangle> out) const;

    /// For each vertex of the complete mesh, the vertex it is one with in the source mesh (itself
    /// for most); empty when nothing was cut or the stream is not complete.
    [[nodiscard]] std::span<const std::uint32_t> stitches() const;

    /// Attributes of the last level that has all of them; nullptr as long as there are none and while those
    /// of a level come. They fit the triangles of the level that they came with, until the next chunk
    /// changes these.
    [[nodiscard]] const LevelAttributes* attributes() const;

    /// Copies the mesh shown with its neighbours and the positions on the level's grid, in the order of
    /// slots. Cost: linear.
    [[nodiscard]] LevelMesh level_mesh() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Copies the decoder's current mesh, model units; at the complete level cut vertices are stitched
/// when `stitch` is set (vertices that stitching leaves unused are dropped).
[[nodiscard]] IndexedMesh extract_mesh(const StreamDecoder& decoder, bool stitch = true);

/// Copies the complete mesh on the grid, unstitched. Precondition: decoder.complete().
[[nodiscard]] GridMesh extract_grid_mesh(const StreamDecoder& decoder);

}  // namespace vsplit::codec
