#include "surface_picture.h"

namespace vsplit::client {

Result<Image> surface_picture(
    const SurfaceArrays& arrays,
    const Appearance* appearance,
    std::span<const Raster> images,
    const View& view,
    const RenderOptions& options
)
{
    const auto renderer = Renderer::create(options);
    VSPLIT_TRY(renderer);
    SurfaceRenderer& surface = (*renderer)->surface();
    if (appearance != nullptr)
    {
        surface.set_appearance(*appearance);
    }
    for (std::uint32_t image = 0; image < images.size(); ++image)
    {
        if (!images[image].pixels.empty())
        {
            VSPLIT_TRY(surface.replace_texture(image, images[image]));
        }
    }
    VSPLIT_TRY((*renderer)->show(arrays));
    return (*renderer)->picture(view);
}

}  // namespace vsplit::client
