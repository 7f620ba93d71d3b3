#include "gl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <string>
#include <string_view>

namespace vsplit::client {
namespace {

tl::unexpected<Error> unavailable(std::string_view step)
{
    return fail(
        ErrorCode::Internal,
        "OpenGL ES without a display is not available (" + std::string(step) +
            " failed); install libegl-mesa0 and libgl1-mesa-dri, or run with --no-render"
    );
}

EGLDisplay surfaceless_display()
{
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (extensions == nullptr ||
        std::string_view(extensions).find("EGL_MESA_platform_surfaceless") ==
            std::string_view::npos)
    {
        return EGL_NO_DISPLAY;
    }
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT")
    );
    return get_display == nullptr
               ? EGL_NO_DISPLAY
               : get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

}  // namespace

Result<std::unique_ptr<GlContext>> GlContext::create()
{
    std::unique_ptr<GlContext> result(new GlContext);
    const EGLDisplay display = surfaceless_display();
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE)
    {
        return unavailable("opening EGL's surfaceless platform");
    }
    result->display_ = display;
    constexpr std::array<EGLint, 5> kConfig{
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglBindAPI(EGL_OPENGL_ES_API) != EGL_TRUE ||
        eglChooseConfig(display, kConfig.data(), &config, 1, &count) != EGL_TRUE || count < 1)
    {
        return unavailable("choosing an OpenGL ES 3 configuration");
    }
    constexpr std::array<EGLint, 3> kVersion{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, kVersion.data());
    if (context == EGL_NO_CONTEXT)
    {
        return unavailable("creating an OpenGL ES 3 context");
    }
    result->context_ = context;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE)
    {
        return unavailable("using a context without a surface");
    }
    return result;
}

GlContext::~GlContext()
{
    // The display belongs to the process: terminating it would end every other context of it too.
    if (context_ != nullptr)
    {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
}

}  // namespace vsplit::client
