#pragma once

#include "core/result.h"
#include "scene/appearance.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::scene {

/// Bounds that a reader sets before it trusts an appearance chunk; a writer keeps to the defaults.
struct AppearanceLimits
{
    std::size_t max_materials = 4096;
    std::size_t max_groups = 65536;
    std::size_t max_images = 256;
    std::size_t max_name_bytes = 1024;
    std::uint32_t max_image_side = 32768;
    std::size_t max_bytes = std::size_t{1} << 24U;  ///< Of the payload.
};

/// Writes an appearance chunk's payload.
/// `with_names`: false leaves all names out. Names that are too long are cut, bytes of them that are
/// not printable UTF-8 become '?'; factors are clamped into their ranges, those that are not numbers
/// take their defaults.
/// Errors: InputTooLarge when there is more of something than AppearanceLimits allows, BadIndex for
/// references to images and materials that do not exist or image sizes out of range.
/// Source: proto/TEXTURE_CHUNKS.md, "Appearance chunk".
[[nodiscard]] Result<std::vector<std::byte>> encode_appearance(
    const Appearance& appearance, bool with_names = true
);

/// Reads an appearance chunk.
/// `payload`: the chunk without its checksum; need not be aligned.
/// Errors: BadChunk when it is malformed, refers to what does not exist or holds values out of range;
/// LimitExceeded. Safe on untrusted input.
[[nodiscard]] Result<Appearance> decode_appearance(
    std::span<const std::byte> payload, const AppearanceLimits& limits = {}
);

}  // namespace vsplit::scene
