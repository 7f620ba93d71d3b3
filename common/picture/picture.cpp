// Based on: Catmull, "A Subdivision Algorithm for Computer Display of Curved Surfaces", 1974 (depths by
// pixel). What is seen is found first and coloured then, once a pixel: Deering and others, "The Triangle
// Processor and Normal Vector Shader", 1988.
#include "picture/picture.h"

#include "core/assert.h"
#include "picture/projected.h"
#include "picture/surface_shader.h"

#include <algorithm>

namespace vsplit::picture {
namespace {

/// Behind every model.
constexpr std::uint8_t kBackground = 96;
[[maybe_unused]] constexpr std::uint32_t kLargestSide = 4096;

/// A drawing under way.
class Canvas
{
public:
    Canvas(const Scene& scene, const View& view, const DrawOptions& options)
        : triangles_(scene.surface->mesh.triangles),
          projection_(view.projection),
          vertices_(project(scene.surface->mesh.positions, view, options.size)),
          shader_(scene, view)
    {
        const std::size_t pixels = std::size_t{options.size} * options.size;
        picture_.size = options.size;
        picture_.depths.assign(pixels, Picture::kNothing);
        picture_.triangles.assign(pixels, Picture::kNoTriangle);
    }

    void find_seen()
    {
        for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        {
            const auto screen = ScreenTriangle::make(vertices_, triangles_[i], projection_);
            if (screen)
            {
                add(i, *screen);
            }
        }
    }

    void color()
    {
        picture_.colors.assign(3 * picture_.triangles.size(), kBackground);
        for (std::size_t pixel = 0; pixel < picture_.triangles.size(); ++pixel)
        {
            if (!picture_.covered(pixel))
            {
                continue;
            }
            const std::uint32_t triangle = picture_.triangles[pixel];
            const auto screen = ScreenTriangle::make(vertices_, triangles_[triangle], projection_);
            const auto rgb = shader_.color(
                triangle,
                *screen,
                static_cast<std::int64_t>(pixel % picture_.size),
                static_cast<std::int64_t>(pixel / picture_.size)
            );
            std::ranges::copy(rgb, &picture_.colors[3 * pixel]);
        }
    }

    Picture take() { return std::move(picture_); }

private:
    void add(std::uint32_t triangle, const ScreenTriangle& screen)
    {
        const bool masked = shader_.has_mask(triangle);
        screen.visit_pixels(picture_.size, [&](std::int64_t x, std::int64_t y) {
            const auto pixel = static_cast<std::size_t>(y * picture_.size + x);
            const auto depth = static_cast<float>(screen.depth(x, y));
            if (depth < picture_.depths[pixel] &&
                (!masked || shader_.is_seen(triangle, screen, x, y)))
            {
                picture_.depths[pixel] = depth;
                picture_.triangles[pixel] = triangle;
            }
        });
    }

    const std::vector<Triangle>& triangles_;
    Projection projection_;
    std::vector<ScreenVertex> vertices_;
    SurfaceShader shader_;
    Picture picture_;
};

}  // namespace

Picture draw(const Scene& scene, const View& view, const DrawOptions& options)
{
    VSPLIT_ASSERT(scene.surface != nullptr && options.size > 0 && options.size <= kLargestSide);
    Canvas canvas(scene, view, options);
    canvas.find_seen();
    if (options.color)
    {
        canvas.color();
    }
    return canvas.take();
}

}  // namespace vsplit::picture
