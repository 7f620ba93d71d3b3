#pragma once

#include "scene/appearance.h"
#include "scene/appearance_chunk.h"

#include <cstdint>
#include <string>

namespace vsplit::scene {

inline constexpr std::uint8_t kMaxTexCoordSet = 7;

/// Texture coordinate sets, wraps and image index exist. `images`: number of images.
[[nodiscard]] bool is_valid(const TextureUse& use, std::size_t images);

/// Every member of a material is in its range, see "Ranges" in proto/TEXTURE_CHUNKS.md; names are not
/// looked at. `images`: number of images.
[[nodiscard]] bool is_valid(const Material& material, std::size_t images);

/// An image's size is one that can be coded.
[[nodiscard]] bool is_valid(const ImageInfo& image, const AppearanceLimits& limits);

/// A name is printable UTF-8 and not too long.
[[nodiscard]] bool is_valid_name(const std::string& name, std::size_t max_bytes);

/// The nearest material whose factors are in their ranges; textures and name stay.
[[nodiscard]] Material clamped(Material material);

/// A name that is_valid_name() accepts: cut at a character, what is not printable replaced by '?'.
[[nodiscard]] std::string printable(const std::string& name, std::size_t max_bytes);

}  // namespace vsplit::scene
