#pragma once

#include "picture/picture.h"
#include "picture/projected.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::picture {

/// Colours of the points of a model. Thread safe once made.
class SurfaceShader
{
public:
    /// Derives normals where the surface has none. Everything given must outlive it.
    /// Cost: linear in triangles.
    SurfaceShader(const Scene& scene, const View& view);

    /// True when parts of a triangle may be transparent.
    [[nodiscard]] bool has_mask(std::uint32_t triangle) const;

    /// True when a pixel of such a triangle is to be seen.
    [[nodiscard]] bool is_seen(
        std::uint32_t triangle, const ScreenTriangle& screen, std::int64_t x, std::int64_t y
    ) const;

    /// The colour of a triangle at a pixel.
    [[nodiscard]] std::array<std::uint8_t, 3> color(
        std::uint32_t triangle, const ScreenTriangle& screen, std::int64_t x, std::int64_t y
    ) const;

private:
    [[nodiscard]] const Material* material(std::uint32_t triangle) const;
    [[nodiscard]] Rgba base_color(
        std::uint32_t triangle, const ScreenTriangle& screen, std::int64_t x, std::int64_t y
    ) const;
    [[nodiscard]] Vector normal(std::uint32_t triangle, const Shares& shares) const;
    [[nodiscard]] Vector derived_normal(std::uint32_t triangle, const Shares& shares) const;
    void derive_normals();

    /// Sums over the triangles around a vertex.
    struct VertexSum
    {
        Vector areas{};     ///< Area vectors.
        double area = 0.0;  ///< Areas.
    };

    const Surface& surface_;
    const Scene& scene_;
    Vector to_viewer_;
    Vector to_light_;
    const SurfaceAttribute* normals_ = nullptr;
    const SurfaceAttribute* colors_ = nullptr;
    std::array<const SurfaceAttribute*, 256> coordinates_{};  ///< By set.
    std::vector<VertexSum> derived_;
};

}  // namespace vsplit::picture
