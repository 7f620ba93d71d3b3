#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// A base mesh as Draco codes it.
struct EncodedBase
{
    std::vector<std::byte> bytes;         ///< The Draco stream.
    GridMesh decoded;                     ///< What the decoder will get.
    std::vector<std::uint32_t> vertices;  ///< By decoded vertex its index in the mesh given.
};

/// Codes a base mesh with Draco's edgebreaker and finds out in which order its vertices come back.
/// `base`: a 2-manifold with boundary, every vertex used; coordinates on the base's grid.
/// Error: Internal when Draco fails or changes the mesh.
[[nodiscard]] Result<EncodedBase> encode_base_mesh(const GridMesh& base);

}  // namespace vsplit::codec
