#include "codec/level_mesh.h"

namespace vsplit::codec {

LevelMesh level_mesh(const RefinementMesh& mesh)
{
    LevelMesh level;
    level.triangles.resize(mesh.face_count());
    level.opposite.resize(mesh.face_count());
    const Face* faces = mesh.faces();
    for (const auto range : mesh.face_ranges())
    {
        for (const Face& face : range)
        {
            level.triangles[face.slot] = face.vertex;
            for (std::size_t k = 0; k < 3; ++k)
            {
                const Corner across = face.opposite[k];
                level.opposite[face.slot][k] =
                    across < 0 ? -1
                               : static_cast<Corner>(4 * faces[across >> 2].slot) + (across & 3);
            }
        }
    }
    level.positions.reserve(mesh.vertex_count());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    {
        const Point& point = mesh.points()[v];
        level.positions.push_back(
            {static_cast<std::int32_t>(point.x),
             static_cast<std::int32_t>(point.y),
             static_cast<std::int32_t>(point.z)}
        );
    }
    return level;
}

LevelMesh level_mesh(
    std::span<const GrownFace> faces, std::span<const std::array<std::int32_t, 3>> positions
)
{
    LevelMesh level;
    level.triangles.reserve(faces.size());
    level.opposite.reserve(faces.size());
    for (const GrownFace& face : faces)
    {
        level.triangles.push_back(face.vertex);
        level.opposite.push_back(face.opposite);
    }
    level.positions.assign(positions.begin(), positions.end());
    return level;
}

std::vector<Corner> first_corners(const LevelMesh& mesh)
{
    std::vector<Corner> first(mesh.positions.size(), -1);
    for (Corner corner = 0; corner < static_cast<Corner>(4 * mesh.triangles.size()); ++corner)
    {
        if ((corner & 3) == 3)
        {
            continue;
        }
        Corner& best = first[mesh.vertex(corner)];
        // Nothing lies before a fan that begins at the boundary.
        if (best < 0 || mesh.across(previous_corner(corner)) < 0)
        {
            best = corner;
        }
    }
    return first;
}

}  // namespace vsplit::codec
