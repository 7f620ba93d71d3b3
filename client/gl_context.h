#pragma once

#include "core/result.h"

#include <memory>

namespace vsplit::client {

/// An OpenGL ES 3 context that needs no display: EGL on Mesa's surfaceless platform. Everything is
/// drawn into framebuffer objects. Current on the thread that created it; use it there only.
class GlContext
{
public:
    /// Opens EGL and makes the context current.
    /// Error: Internal with what is missing and what to do; nothing stays open then.
    [[nodiscard]] static Result<std::unique_ptr<GlContext>> create();

    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

private:
    GlContext() = default;

    // EGLDisplay and EGLContext are pointers; EGL's headers stay out of this one.
    void* display_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace vsplit::client
