#pragma once

#include "codec/small_base_limits.h"
#include "core/result.h"
#include "format.h"
#include "mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// A base mesh as its codec has it.
struct EncodedBase
{
    std::uint8_t codec = proto::kDracoBaseCodec;
    std::vector<std::byte> bytes;
    GridMesh decoded;                     ///< What the decoder will get.
    std::vector<std::uint32_t> vertices;  ///< By decoded vertex its index in the mesh given.
};

/// Codes a base mesh with Draco's edgebreaker and finds out in which order its vertices come back.
/// `base`: a 2-manifold with boundary, every vertex used; coordinates on the base's grid.
/// Error: Internal when Draco fails or changes the mesh.
[[nodiscard]] Result<EncodedBase> encode_draco_base(const GridMesh& base);

/// Codes a base mesh with kSmallBaseCodec, beginning at the face from which it takes the fewest bytes
/// when it is small enough to try all.
/// `base`: as above, at most kMaxSmallBaseVertices vertices and kMaxSmallBaseFaces faces a vertex;
/// `extent`: largest coordinate per axis on the base's grid. Result: without bytes when that fails.
[[nodiscard]] EncodedBase encode_small_base(
    const GridMesh& base,
    const std::array<std::int32_t, 3>& extent,
    ComponentStart start = ComponentStart::Centre
);

/// Codes a base mesh with the codec that takes fewer bytes. Arguments and error as above.
[[nodiscard]] Result<EncodedBase> encode_base_mesh(
    const GridMesh& base, const std::array<std::int32_t, 3>& extent
);

}  // namespace vsplit::codec
