#pragma once

#include "core/result.h"
#include "mesh/surface.h"

#include <memory>
#include <span>
#include <vector>

namespace vsplit::bench {

/// Bits that Draco's attributes are quantised to; colours are coded as the bytes that they are.
struct DracoBits
{
    int position = 12;
    int tex_coord = 10;
    int normal = 8;
    int generic = 8;
};

/// Codes a mesh and what lies on it with Draco as `draco_encoder -cl 10` does: edgebreaker, slowest
/// and smallest, seams where the corners' values differ. Vertices at one place stay apart, so that
/// exactly the given mesh is coded.
/// Error: Internal, when Draco refuses.
[[nodiscard]] Result<std::vector<char>> encode_surface_with_draco(
    const Surface& surface, const DracoBits& bits
);

/// Decodes what encode_surface_with_draco() made. Kinds and sets of attributes come back in the order of
/// the file. Error: Internal.
[[nodiscard]] Result<Surface> decode_surface_with_draco(std::span<const char> bytes);

}  // namespace vsplit::bench
