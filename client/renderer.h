#pragma once

#include "core/result.h"
#include "gpu_buffers.h"
#include "image.h"
#include "surface_renderer.h"
#include "view.h"

#include <cstdint>
#include <memory>

namespace vsplit::client {

class GlContext;

/// How the renderer draws.
struct RenderOptions
{
    std::uint32_t width = 240;   ///< Pixels.
    std::uint32_t height = 320;  ///< Pixels.
    bool wireframe = false;      ///< Draw every edge over the surface (the grid display).
};

/// Draws the refining mesh off screen with OpenGL ES 3. Vertex and index memory on the GPU is
/// allocated once; afterwards only changed ranges are uploaded. Use on one thread, one at a time: its
/// context is current while it lives.
class Renderer
{
public:
    /// Opens the context, builds the programs and the framebuffer.
    /// Error: Internal when OpenGL ES is not available or refuses the size.
    [[nodiscard]] static Result<std::unique_ptr<Renderer>> create(const RenderOptions& options);

    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Allocates GPU arrays for so many vertices and triangles. Error: LimitExceeded when the driver
    /// has no memory for them.
    [[nodiscard]] Result<void> reserve(std::uint32_t vertices, std::uint32_t faces);

    /// Uploads what changed in `buffers` since the last call.
    /// Precondition: the arrays fit what was reserved. Cost: linear in the dirty ranges.
    void upload(GpuBuffers& buffers);

    /// Replaces the model by a level with attributes, drawn instead of what upload() gets.
    /// Error: LimitExceeded when the driver has no memory for it.
    [[nodiscard]] Result<void> show(const SurfaceArrays& arrays);

    /// Materials and textures of levels with attributes.
    [[nodiscard]] SurfaceRenderer& surface() { return *surface_; }

    /// Draws one frame and waits until it is finished.
    void draw(const View& view);

    /// Draws one frame with four samples a pixel and reads it. Errors: Internal when the driver fails.
    [[nodiscard]] Result<Image> picture(const View& view);

private:
    struct Objects;

    explicit Renderer(const RenderOptions& options);
    [[nodiscard]] Result<void> build();
    void draw_scene(const View& view) const;
    void draw_model(const View& view) const;
    void draw_lines(const View& view) const;
    void upload_lines(std::span<const Triangle> triangles, const ElementRange& range);

    RenderOptions options_;
    std::unique_ptr<GlContext> context_;
    std::unique_ptr<Objects> objects_;
    std::unique_ptr<SurfaceRenderer> surface_;
    std::uint32_t face_count_ = 0;
};

}  // namespace vsplit::client
