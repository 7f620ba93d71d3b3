#include "saved_level.h"

#include "ply_file.h"

namespace vsplit::client {

Result<void> save_level(const std::filesystem::path& path, const Refiner& refiner)
{
    const codec::StreamDecoder& decoder = refiner.decoder();
    const codec::LevelAttributes* attributes = refiner.level_attributes();
    if (attributes == nullptr)
    {
        return write_ply(path, codec::extract_mesh(decoder));
    }
    const SurfaceArrays values = refiner.make_surface(nullptr);
    if (!has_ply_values(values))
    {
        return write_ply(path, codec::extract_mesh(decoder));
    }
    const IndexedMesh mesh = codec::extract_mesh(decoder, false);
    IndexedMesh wedges;
    wedges.triangles = attributes->wedges;
    wedges.positions.reserve(attributes->wedge_vertices.size());
    for (const std::uint32_t vertex : attributes->wedge_vertices)
    {
        wedges.positions.push_back(mesh.positions[vertex]);
    }
    return write_ply(path, wedges, values);
}

}  // namespace vsplit::client
