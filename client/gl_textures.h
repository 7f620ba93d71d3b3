#pragma once

#include "core/result.h"
#include "image/raster.h"
#include "scene/appearance.h"

#include <cstdint>
#include <vector>

namespace vsplit::client {

/// Returns the memory that a texture of this size takes on the GPU with its mipmaps, bytes.
[[nodiscard]] constexpr std::uint64_t texture_bytes(std::uint64_t width, std::uint64_t height)
{
    return (4 * width * height * 4 + 2) / 3;
}

/// The textures of a model on the GPU, by image; each is replaced as its image sharpens. Needs a current
/// OpenGL ES 3 context for as long as it lives.
class GlTextures
{
public:
    /// Allocates nothing yet.
    GlTextures() = default;
    ~GlTextures();
    GlTextures(const GlTextures&) = delete;
    GlTextures& operator=(const GlTextures&) = delete;

    /// Forgets all and prepares for the images of a model; which of them hold colours the materials say.
    void prepare(const Appearance& appearance);

    /// Replaces the texture of an image and makes its mipmaps.
    /// `raster`: at most as large as the driver can have textures. Precondition: `image` < images.
    /// Errors: LimitExceeded when the driver refuses the size or has no memory; what was shown stays.
    [[nodiscard]] Result<void> replace(std::uint32_t image, const Raster& raster);

    /// Binds the texture of a use to a unit with its wrap modes.
    /// Result: false, and nothing bound, when it has no texture or nothing of it came yet.
    bool bind(unsigned unit, const TextureUse& use) const;

    /// Memory of all textures with mipmaps, bytes.
    [[nodiscard]] std::uint64_t bytes() const;

private:
    struct Texture
    {
        unsigned name = 0;
        bool is_color = false;  ///< Its values are sRGB.
        std::uint32_t width = 0;
        std::uint32_t height = 0;
    };

    std::vector<Texture> textures_;
};

/// Returns an image as four channels, as textures take it. Cost: linear. Thread safe.
[[nodiscard]] std::vector<std::uint8_t> to_rgba(const Raster& raster);

/// By image whether it is drawn at all: as base colour, emission or normals of a material.
[[nodiscard]] std::vector<bool> drawn_images(const Appearance& appearance);

}  // namespace vsplit::client
