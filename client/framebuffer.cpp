#include "framebuffer.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace vsplit::client {

Framebuffer::~Framebuffer()
{
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(1, &colour_);
    glDeleteRenderbuffers(1, &depth_);
}

Result<void> Framebuffer::allocate(std::uint32_t width, std::uint32_t height, int samples)
{
    width_ = width;
    height_ = height;
    GLint most_samples = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    const GLint used_samples = std::min<GLint>(samples, most_samples);
    const auto storage = [&](unsigned& name, GLenum format) {
        glGenRenderbuffers(1, &name);
        glBindRenderbuffer(GL_RENDERBUFFER, name);
        glRenderbufferStorageMultisample(
            GL_RENDERBUFFER,
            used_samples,
            format,
            static_cast<GLsizei>(width),
            static_cast<GLsizei>(height)
        );
    };
    storage(colour_, GL_RGBA8);
    storage(depth_, GL_DEPTH_COMPONENT24);
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    {
        return fail(
            ErrorCode::Internal,
            "the driver cannot draw a picture of " + std::to_string(width) + " x " +
                std::to_string(height) + " pixels"
        );
    }
    return {};
}

void Framebuffer::bind() const
{
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
}

void Framebuffer::resolve_into(const Framebuffer& target) const
{
    const auto width = static_cast<GLint>(width_);
    const auto height = static_cast<GLint>(height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer_);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Image Framebuffer::read() const
{
    const std::size_t pixels = std::size_t{width_} * height_;
    std::vector<std::uint8_t> rgba(4 * pixels);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(
        0,
        0,
        static_cast<GLsizei>(width_),
        static_cast<GLsizei>(height_),
        GL_RGBA,
        GL_UNSIGNED_BYTE,
        rgba.data()
    );
    Image image{width_, height_, std::vector<std::uint8_t>(3 * pixels)};
    for (std::size_t y = 0; y < height_; ++y)
    {
        // OpenGL counts rows from the bottom.
        const std::size_t row = (height_ - 1 - y) * width_;
        for (std::size_t x = 0; x < width_; ++x)
        {
            std::copy_n(&rgba[4 * (row + x)], 3, &image.pixels[3 * (y * width_ + x)]);
        }
    }
    return image;
}

}  // namespace vsplit::client
