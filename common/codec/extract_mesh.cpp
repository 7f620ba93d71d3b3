#include "codec/stream_decoder.h"
#include "core/assert.h"

#include <algorithm>

namespace vsplit::codec {

IndexedMesh extract_mesh(const StreamDecoder& decoder, bool stitch)
{
    IndexedMesh mesh;
    mesh.triangles.resize(decoder.faces());
    decoder.write_triangles(mesh.triangles);
    const auto stitches = stitch ? decoder.stitches() : std::span<const std::uint32_t>{};
    std::vector<std::uint32_t> place(stitches.size(), 0);
    for (std::uint32_t v = 0; v < decoder.vertices(); ++v)
    {
        if (!stitches.empty() && stitches[v] != v)
        {
            place[v] = place[stitches[v]];
            continue;
        }
        if (!stitches.empty())
        {
            place[v] = static_cast<std::uint32_t>(mesh.positions.size());
        }
        mesh.positions.push_back(
            dequantize(decoder.info()->grid, decoder.grid_position(v), decoder.shift())
        );
    }
    if (!stitches.empty())
    {
        for (Triangle& triangle : mesh.triangles)
        {
            std::ranges::transform(triangle, triangle.begin(), [&](std::uint32_t v) {
                return place[v];
            });
        }
    }
    return mesh;
}

GridMesh extract_grid_mesh(const StreamDecoder& decoder)
{
    VSPLIT_ASSERT(decoder.complete());
    GridMesh mesh;
    mesh.triangles.resize(decoder.faces());
    decoder.write_triangles(mesh.triangles);
    for (std::uint32_t v = 0; v < decoder.vertices(); ++v)
    {
        mesh.positions.push_back(decoder.grid_position(v));
    }
    return mesh;
}

}  // namespace vsplit::codec
