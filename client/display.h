#pragma once

#include "codec/stream_info.h"
#include "core/result.h"
#include "gpu_buffers.h"
#include "options.h"
#include "renderer.h"
#include "view.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace vsplit::client {

/// The device's screen: a slowly turning model, and pictures of it. Use on one thread.
class Display
{
public:
    /// Opens OpenGL ES and makes the folder for pictures.
    /// Errors: Internal (no OpenGL ES), IoError (the folder).
    [[nodiscard]] static Result<std::unique_ptr<Display>> create(const Options& options);

    /// Prepares for a model: camera from its bounding box, GPU memory for so many elements.
    /// `info`: header and index, cut to what will be shown; `surface`: levels come with show().
    /// Error: LimitExceeded.
    [[nodiscard]] Result<void> prepare(const codec::StreamInfo& info, bool surface = false);

    /// Replaces the model by a level with attributes. Error: LimitExceeded.
    [[nodiscard]] Result<void> show(const SurfaceArrays& arrays) { return renderer_->show(arrays); }

    /// Sets the materials of such levels.
    void set_appearance(const Appearance& appearance);

    /// Replaces the texture of an image. Error: LimitExceeded.
    [[nodiscard]] Result<void> replace_texture(std::uint32_t image, const Raster& raster);

    /// Memory of the textures with mipmaps, bytes.
    [[nodiscard]] std::uint64_t texture_memory_bytes() const;

    /// Uploads what changed, draws the next frame and waits until it is finished; returns how long
    /// that took. Precondition: prepare() succeeded.
    std::chrono::duration<double, std::milli> draw(GpuBuffers& buffers);

    /// Writes level-NNN.png, if pictures were asked for. All are taken from the same side, so that
    /// levels can be compared. Errors: IoError, Internal. Precondition: draw() was called.
    [[nodiscard]] Result<void> save_picture(std::uint32_t level);

private:
    Display(const Options& options, std::unique_ptr<Renderer> renderer);

    double aspect_;
    UpAxis up_;
    std::filesystem::path folder_;
    std::unique_ptr<Renderer> renderer_;
    std::optional<Turntable> turntable_;
    std::uint64_t frame_ = 0;
};

}  // namespace vsplit::client
