#pragma once

#include "mesh/surface.h"
#include "picture/texture.h"
#include "picture/view.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vsplit::picture {

/// What a picture is drawn of. Everything must outlive the drawing.
struct Scene
{
    const Surface* surface = nullptr;
    const Appearance* appearance = nullptr;  ///< nullptr: no materials.
    std::span<const Texture> textures{};     ///< By image; missing or empty ones count as none.
};

/// Choices of a drawing.
struct DrawOptions
{
    std::uint32_t size = 512;  ///< Pixels a side, 1 .. 4096.
    bool color = true;         ///< False: only which triangle is seen, and its depth.
};

/// What one view shows: square, rows from the top.
struct Picture
{
    /// Depth of pixels that nothing covers.
    static constexpr float kNothing = std::numeric_limits<float>::infinity();
    /// Triangle of pixels that nothing covers.
    static constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t size = 0;            ///< Pixels a side.
    std::vector<std::uint8_t> colors;  ///< Red, green and blue by pixel; empty if not asked for.
    std::vector<float> depths;         ///< By pixel the distance along View::forward, model units.
    std::vector<std::uint32_t> triangles;  ///< By pixel the triangle that is seen.

    /// True when something is seen at a pixel.
    [[nodiscard]] bool covered(std::size_t pixel) const { return triangles[pixel] != kNoTriangle; }

    /// Memberwise equality.
    friend bool operator==(const Picture&, const Picture&) = default;
};

/// Draws a model in software, the same on every machine: integers for what is covered (triangles that
/// share an edge leave neither gaps nor overlaps), IEEE + - * / sqrt for the rest. Both sides of
/// triangles are seen, with perspective-correct texture coordinates and colours, the base colours of
/// the materials, alpha as a mask (blended materials: where at least half is covered), and a fixed
/// light over the viewer's shoulder. Where the surface has no normals, they are derived: the smooth
/// normal where the triangles around a vertex nearly agree, the triangle's elsewhere.
/// Precondition: indices within their tables, numbers finite.
/// Result: a picture of options.size. Cost: linear in triangles and pixels. Thread safe.
[[nodiscard]] Picture draw(const Scene& scene, const View& view, const DrawOptions& options = {});

}  // namespace vsplit::picture
