#pragma once

#include "core/result.h"
#include "image.h"

#include <cstdint>

namespace vsplit::client {

/// A picture to draw into: colour and depth of one size. Needs a current OpenGL ES 3 context for as
/// long as it lives. Moves only by not moving at all: hold it where it was made.
class Framebuffer
{
public:
    /// Allocates nothing yet.
    Framebuffer() = default;
    ~Framebuffer();
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    /// Allocates colour and depth.
    /// `samples`: a pixel, 0 for one without averaging; lowered to what the driver offers.
    /// Error: Internal when the driver refuses.
    [[nodiscard]] Result<void> allocate(std::uint32_t width, std::uint32_t height, int samples);

    /// Makes it the target of drawing, all of it.
    void bind() const;

    /// Averages the samples into `target`, which has the same size.
    void resolve_into(const Framebuffer& target) const;

    /// Reads the colours, rows from the top. Precondition: allocated with 0 samples.
    [[nodiscard]] Image read() const;

private:
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    unsigned framebuffer_ = 0;
    unsigned colour_ = 0;
    unsigned depth_ = 0;
};

}  // namespace vsplit::client
