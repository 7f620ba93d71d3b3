#pragma once

#include "codec/stream_decoder.h"
#include "core/result.h"
#include "gpu_buffers.h"
#include "surface_arrays.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>

namespace vsplit::client {

/// Bytes of chunks by what they are about.
struct ChunkBytes
{
    std::uint64_t geometry = 0;    ///< Base, batches, growth, stitches.
    std::uint64_t attributes = 0;  ///< Attributes.
    std::uint64_t textures = 0;    ///< Materials and images.

    /// Adds a chunk.
    void add(proto::ChunkKind kind, std::uint64_t bytes);

    /// All of them.
    [[nodiscard]] std::uint64_t sum() const { return geometry + attributes + textures; }

    /// Adds what another has.
    ChunkBytes& operator+=(const ChunkBytes& other);

    /// Memberwise equality.
    friend bool operator==(const ChunkBytes&, const ChunkBytes&) = default;
};

/// What Refiner::advance() did.
struct Progress
{
    bool changed = false;  ///< The mesh is finer than before.
    bool level_complete =
        false;         ///< A level was reached with its attributes; advance() stops there.
    ChunkBytes bytes;  ///< Of the chunks that were applied or looked at.
    std::chrono::duration<double> decoding{};  ///< Time for decoding and updating the arrays.
};

/// Takes what a chunk with materials or a part of an image holds.
using AppearanceSink =
    std::function<Result<void>(const codec::ChunkInfo&, std::span<const std::byte>)>;

/// True when a stream has anything that is drawn as levels with attributes: attributes, groups,
/// materials, images.
[[nodiscard]] bool has_surface(const codec::StreamInfo& info);

/// Decodes a stream piece by piece between frames and keeps the arrays for the GPU up to date.
/// Not thread safe. Safe on untrusted input.
class Refiner
{
public:
    /// `info`: header and index of the stream that will be fed, cut to what will be decoded;
    /// `limits`: what the decoder may use; `attributes`: make surfaces with attributes out of what has
    /// them: buffers() then stays empty, and make_surface() gives the arrays of a level.
    Refiner(
        const codec::StreamInfo& info, const codec::DecodeLimits& limits, bool attributes = false
    );
    Refiner(const Refiner&) = delete;
    Refiner& operator=(const Refiner&) = delete;

    /// Where the contents of chunks with materials and images go; nowhere before this is called.
    void set_appearance_sink(AppearanceSink sink) { sink_ = std::move(sink); }

    /// Takes stream bytes, from byte 0 on; returns how many (the rest comes again after advance()).
    /// Errors: those of codec::StreamDecoder::feed().
    [[nodiscard]] Result<std::size_t> feed(std::span<const std::byte> bytes);

    /// Applies complete chunks until the budget is spent, a level is reached or bytes are missing; at
    /// least one chunk when one is complete. Errors: those of codec::StreamDecoder::step() and of the
    /// appearance's sink; the mesh shown before stays good.
    [[nodiscard]] Result<Progress> advance(std::chrono::duration<double> budget);

    /// Says that nothing from an offset of the stream on will come: no level waits for its attributes there.
    void stop_at(std::uint64_t end) { end_ = end; }

    /// Passes over the next chunk; see codec::StreamDecoder::skip().
    void skip();

    /// True when levels are shown with make_surface().
    [[nodiscard]] bool shows_surface() const { return attributes_; }

    /// True when the mesh is a level and not on its way to one.
    [[nodiscard]] bool at_level() const { return at_level_ && !awaiting_; }

    /// The arrays of the level that was reached, with its attributes if they came with it.
    /// `appearance`: its materials sort the triangles; may be null. Cost: linear in the level.
    [[nodiscard]] SurfaceArrays make_surface(const Appearance* appearance) const;

    /// Attributes of the level that was reached; null when it has none.
    [[nodiscard]] const codec::LevelAttributes* level_attributes() const
    {
        return fitting_ ? decoder_.attributes() : nullptr;
    }

    /// The decoder, for its counts and the final mesh.
    [[nodiscard]] const codec::StreamDecoder& decoder() const { return decoder_; }

    /// The arrays to upload and draw.
    [[nodiscard]] GpuBuffers& buffers() { return buffers_; }

private:
    [[nodiscard]] Result<void> follow(const codec::Step& step, Progress& progress);
    [[nodiscard]] bool awaits_attributes() const;

    codec::StreamDecoder decoder_;
    GpuBuffers buffers_;
    PositionSource positions_;
    TriangleSource triangles_;
    AppearanceSink sink_;
    bool attributes_ = false;
    std::uint64_t end_ = std::numeric_limits<std::uint64_t>::max();
    bool at_level_ = false;
    bool awaiting_ = false;  ///< The level is reached, its attributes are on their way.
    bool fitting_ = false;   ///< The decoder's attributes are those of the level.
};

}  // namespace vsplit::client
