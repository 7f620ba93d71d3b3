#pragma once

#include "codec/stream_decoder.h"
#include "core/result.h"
#include "gpu_buffers.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit::client {

/// What Refiner::advance() did.
struct Progress
{
    bool changed = false;                      ///< The mesh is finer than before.
    bool level_complete = false;               ///< A level was reached; advance() stops there.
    std::uint64_t chunk_bytes = 0;             ///< Bytes of the chunks that were applied.
    std::chrono::duration<double> decoding{};  ///< Time for decoding and updating the arrays.
};

/// Decodes a stream piece by piece between frames and keeps the arrays for the GPU up to date.
/// Not thread safe. Safe on untrusted input.
class Refiner
{
public:
    /// `info`: header and index of the stream that will be fed, cut to what will be decoded;
    /// `limits`: what the decoder may use.
    Refiner(const codec::StreamInfo& info, const codec::DecodeLimits& limits);
    Refiner(const Refiner&) = delete;
    Refiner& operator=(const Refiner&) = delete;

    /// Takes stream bytes, from byte 0 on; returns how many (the rest comes again after advance()).
    /// Errors: those of codec::StreamDecoder::feed().
    [[nodiscard]] Result<std::size_t> feed(std::span<const std::byte> bytes);

    /// Applies complete chunks until the budget is spent, a level is reached or bytes are missing; at
    /// least one chunk when one is complete. Errors: those of codec::StreamDecoder::step(); the mesh
    /// shown before stays good.
    [[nodiscard]] Result<Progress> advance(std::chrono::duration<double> budget);

    /// The decoder, for its counts and the final mesh.
    [[nodiscard]] const codec::StreamDecoder& decoder() const { return decoder_; }

    /// The arrays to upload and draw.
    [[nodiscard]] GpuBuffers& buffers() { return buffers_; }

private:
    codec::StreamDecoder decoder_;
    GpuBuffers buffers_;
    PositionSource positions_;
    TriangleSource triangles_;
};

}  // namespace vsplit::client
