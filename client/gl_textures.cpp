#include "gl_textures.h"

#include "core/assert.h"

#include <GLES3/gl3.h>

#include <array>
#include <cstddef>
#include <string>

namespace vsplit::client {
namespace {

GLint to_gl(TextureWrap wrap)
{
    switch (wrap)
    {
        case TextureWrap::Mirror:
            return GL_MIRRORED_REPEAT;
        case TextureWrap::Clamp:
            return GL_CLAMP_TO_EDGE;
        default:
            return GL_REPEAT;
    }
}

bool in_range(const TextureUse& use, std::size_t images)
{
    return use.image >= 0 && static_cast<std::size_t>(use.image) < images;
}

void clear_errors()
{
    while (glGetError() != GL_NO_ERROR)
    {
        // Only errors of the calls that follow count.
    }
}

}  // namespace

std::vector<std::uint8_t> to_rgba(const Raster& raster)
{
    const std::size_t count = std::size_t{raster.width} * raster.height;
    const std::size_t channels = raster.channels;
    VSPLIT_ASSERT(channels >= 1 && channels <= 4 && raster.pixels.size() == count * channels);
    std::vector<std::uint8_t> rgba(4 * count, 255);
    const bool grey = channels < 3;
    const bool alpha = channels == 2 || channels == 4;
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::uint8_t* from = &raster.pixels[i * channels];
        for (std::size_t k = 0; k < 3; ++k)
        {
            rgba[4 * i + k] = from[grey ? 0 : k];
        }
        rgba[4 * i + 3] = alpha ? from[channels - 1] : 255;
    }
    return rgba;
}

std::vector<bool> drawn_images(const Appearance& appearance)
{
    std::vector<bool> drawn(appearance.images.size(), false);
    for (const Material& material : appearance.materials)
    {
        for (const TextureUse* use :
             {&material.base_color_texture, &material.emissive_texture, &material.normal_texture})
        {
            if (in_range(*use, drawn.size()))
            {
                drawn[static_cast<std::size_t>(use->image)] = true;
            }
        }
    }
    return drawn;
}

GlTextures::~GlTextures()
{
    for (const Texture& texture : textures_)
    {
        glDeleteTextures(1, &texture.name);
    }
}

void GlTextures::prepare(const Appearance& appearance)
{
    for (const Texture& texture : textures_)
    {
        glDeleteTextures(1, &texture.name);
    }
    textures_.assign(appearance.images.size(), {});
    for (const Material& material : appearance.materials)
    {
        for (const TextureUse* use : {&material.base_color_texture, &material.emissive_texture})
        {
            if (in_range(*use, textures_.size()))
            {
                textures_[static_cast<std::size_t>(use->image)].is_color = true;
            }
        }
    }
}

Result<void> GlTextures::replace(std::uint32_t image, const Raster& raster)
{
    VSPLIT_ASSERT(image < textures_.size());
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const auto limit = static_cast<std::uint32_t>(most);
    if (raster.width == 0 || raster.height == 0 || raster.width > limit || raster.height > limit)
    {
        return fail(
            ErrorCode::LimitExceeded,
            "the driver has no textures of " + std::to_string(raster.width) + " x " +
                std::to_string(raster.height) + " pixels"
        );
    }
    Texture& texture = textures_[image];
    Texture finer = texture;
    finer.width = raster.width;
    finer.height = raster.height;
    const std::vector<std::uint8_t> rgba = to_rgba(raster);
    clear_errors();
    glGenTextures(1, &finer.name);
    glBindTexture(GL_TEXTURE_2D, finer.name);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(
        GL_TEXTURE_2D,
        0,
        finer.is_color ? GL_SRGB8_ALPHA8 : GL_RGBA8,
        static_cast<GLsizei>(raster.width),
        static_cast<GLsizei>(raster.height),
        0,
        GL_RGBA,
        GL_UNSIGNED_BYTE,
        rgba.data()
    );
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (glGetError() != GL_NO_ERROR)
    {
        glDeleteTextures(1, &finer.name);
        return fail(ErrorCode::LimitExceeded, "the driver has no memory for a texture");
    }
    glDeleteTextures(1, &texture.name);
    texture = finer;
    return {};
}

bool GlTextures::bind(unsigned unit, const TextureUse& use) const
{
    if (!in_range(use, textures_.size()) ||
        textures_[static_cast<std::size_t>(use.image)].name == 0)
    {
        return false;
    }
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, textures_[static_cast<std::size_t>(use.image)].name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, to_gl(use.wrap_u));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, to_gl(use.wrap_v));
    glActiveTexture(GL_TEXTURE0);
    return true;
}

std::uint64_t GlTextures::bytes() const
{
    std::uint64_t sum = 0;
    for (const Texture& texture : textures_)
    {
        sum += texture_bytes(texture.width, texture.height);
    }
    return sum;
}

}  // namespace vsplit::client
