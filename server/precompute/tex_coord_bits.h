#pragma once

#include "mesh/surface.h"
#include "scene/appearance.h"

#include <cstdint>
#include <span>

namespace vsplit::precompute {

inline constexpr std::uint8_t kPlainTexCoordBits = 10;  ///< Where no image is placed.
inline constexpr std::uint8_t kLeastTexCoordBits = 12;  ///< Where an image is placed.
inline constexpr std::uint8_t kMostTexCoordBits = 14;   ///< Even where that is too few.

/// The bits with which texture coordinates are within a sixth of a texel of the images that they place,
/// kLeastTexCoordBits .. kMostTexCoordBits: more for large images and for those that repeat.
/// `attributes`: of the surface; `appearance`: with the sizes of its images in pixels, those with a side
/// above `max_size` taken as scaled down to it. Without images that a material uses: kPlainTexCoordBits.
/// Cost: linear. Thread safe.
[[nodiscard]] std::uint8_t choose_tex_coord_bits(
    std::span<const SurfaceAttribute> attributes,
    const Appearance& appearance,
    std::uint32_t max_size
);

}  // namespace vsplit::precompute
