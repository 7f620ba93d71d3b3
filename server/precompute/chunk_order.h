#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "mesh/surface.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// The stages of a model's shape, its coded images, and what they are coded from.
struct OrderSource
{
    const Surface* original = nullptr;
    const Appearance* appearance = nullptr;
    std::span<const Raster> original_images{};  ///< By image; may be scaled down.
    /// Bytes of one stage after another: a level with its attributes, or what makes the last one better. Not
    /// empty.
    std::vector<std::uint64_t> stage_bytes;
    /// What a client shows after a stage. Called a few times for each of OrderOptions::most_states stages.
    std::function<Result<Surface>(std::uint32_t stage)> stage;
    /// By image the bytes of its chunks, in the order in which they must come; empty for none.
    std::vector<std::vector<std::uint64_t>> texture_bytes;
    /// What an image shows after its first `chunks` >= 1 chunks; sides of OrderOptions::image_side are
    /// enough.
    std::function<Result<Raster>(std::uint32_t image, std::uint32_t chunks)> image;
};

/// Bounds of the measuring.
struct OrderOptions
{
    std::size_t views = 3;             ///< 1 .. 8.
    std::uint32_t picture_side = 256;  ///< Pixels.
    /// Longest side of images that are worth making, pixels. Below that of the original, the finest detail
    /// would seem worthless.
    std::uint32_t image_side = 1024;
    std::size_t most_states = 40;  ///< Stages and image states together that are looked at.
    /// States of the whole model that are drawn, in all views each.
    std::size_t most_pictures = 120;
};

/// One step of an order: a stage of the shape, or a chunk of an image.
struct OrderStep
{
    static constexpr std::int32_t kGeometry = -1;

    std::int32_t image = kGeometry;  ///< Which image, or kGeometry.
    std::uint32_t index = 0;         ///< The stage, or the number of the chunk in its image.
    std::uint64_t bytes = 0;
    double error = 0.0;     ///< Mean squared image error after it, 0 .. 65025.
    bool measured = false;  ///< False: `error` is interpolated between measured states.
};

/// Stages and image chunks in the order in which they should lie in a file.
struct ChunkOrder
{
    std::vector<OrderStep> steps;  ///< Starts with stage 0; stages and chunks of an image ascend.

    /// The stage after which a chunk of an image goes. Precondition: it is among the steps.
    [[nodiscard]] std::uint32_t stage_before(std::uint32_t image, std::uint32_t chunk) const;
};

/// Interleaves stages and image chunks so that every step lowers the error of the picture the most for
/// its bytes: the model is drawn with both as they would be and compared with the original. Only a
/// spread of the stages and chunks is drawn, what lies between follows. Images that no base colour shows
/// are judged by their own error, scaled down, as the drawing does not show them.
/// Errors: those of the callbacks. Cost: at most most_pictures times drawing the views. Deterministic,
/// on every machine. Thread safe when the callbacks are.
[[nodiscard]] Result<ChunkOrder> order_chunks(
    const OrderSource& source, const OrderOptions& options = {}
);

}  // namespace vsplit::precompute
