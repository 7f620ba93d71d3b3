#pragma once

#include "core/result.h"
#include "gl_textures.h"
#include "image/raster.h"
#include "scene/appearance.h"
#include "surface_arrays.h"
#include "view.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vsplit::client {

/// Draws levels with attributes: colours, normals, textures and base-colour materials. Needs a current
/// OpenGL ES 3 context for as long as it lives.
class SurfaceRenderer
{
public:
    /// Builds the programs. Error: Internal with the driver's log.
    [[nodiscard]] static Result<std::unique_ptr<SurfaceRenderer>> create();

    ~SurfaceRenderer();
    SurfaceRenderer(const SurfaceRenderer&) = delete;
    SurfaceRenderer& operator=(const SurfaceRenderer&) = delete;

    /// Sets the materials; forgets the textures of others. Arrays that were made for other materials
    /// are drawn without.
    void set_appearance(const Appearance& appearance);

    /// Replaces the arrays on the GPU. Error: LimitExceeded when the driver has no memory for them.
    [[nodiscard]] Result<void> upload(const SurfaceArrays& arrays);

    /// Replaces the texture of an image; see GlTextures::replace(). An image that the materials do not
    /// have is ignored.
    [[nodiscard]] Result<void> replace_texture(std::uint32_t image, const Raster& raster);

    /// True once arrays were uploaded.
    [[nodiscard]] bool has_surface() const { return has_surface_; }

    /// Triangles that are drawn.
    [[nodiscard]] std::uint32_t face_count() const { return face_count_; }

    /// Draws what was uploaded into the bound framebuffer: what hides first, then the rest from far to
    /// near. Depth testing is on.
    void draw(const View& view) const;

    /// Binds the vertex arrays, for drawing lines over the surface.
    void bind_arrays() const;

    /// Memory of the textures with mipmaps, bytes.
    [[nodiscard]] std::uint64_t texture_memory_bytes() const { return textures_.bytes(); }

private:
    struct Objects;

    SurfaceRenderer();
    [[nodiscard]] Result<void> build();
    void use_material(const DrawRange& range) const;
    void draw_range(const DrawRange& range) const;
    [[nodiscard]] bool is_blended(const DrawRange& range) const;

    std::unique_ptr<Objects> objects_;
    GlTextures textures_;
    Appearance appearance_;
    std::vector<DrawRange> ranges_;
    std::uint32_t face_count_ = 0;
    bool has_surface_ = false;
    bool has_colors_ = false;
};

}  // namespace vsplit::client
