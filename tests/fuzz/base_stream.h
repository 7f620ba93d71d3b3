#pragma once

#include "codec/base_mesh_encoder.h"
#include "codec/stream_parts.h"
#include "mesh/indexed_mesh.h"
#include "mesh/quantization_grid.h"

#include <cstdint>

namespace vsplit::fuzz {

/// Position bits of the streams that fuzzers build on.
inline constexpr int kBits = 10;

/// A stream that is nothing but a base, whose positions lack `shift` bits.
[[nodiscard]] inline test::StreamParts base_stream(const IndexedMesh& mesh, int shift)
{
    test::StreamParts parts;
    parts.info.grid = make_grid(mesh.positions, kBits);
    GridMesh base = quantize(parts.info.grid, mesh);
    for (auto& position : base.positions)
    {
        for (std::int32_t& coordinate : position)
        {
            coordinate >>= shift;
        }
    }
    codec::ChunkInfo row;
    row.kind = proto::ChunkKind::Base;
    row.vertices = static_cast<std::uint32_t>(base.positions.size());
    row.faces = static_cast<std::uint32_t>(base.triangles.size());
    row.shift = shift;
    parts.info.chunks.push_back(row);
    parts.chunks.push_back(codec::encode_draco_base(base).value().bytes);
    return parts;
}

}  // namespace vsplit::fuzz
