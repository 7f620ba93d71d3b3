#pragma once

#include "codec/growth_coder.h"
#include "codec/level_mesh.h"
#include "codec/refinement_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace vsplit::codec {

/// The mesh that a decoder shows: one that splits made, or the complete one that was grown.
class ShownMesh
{
public:
    /// `growth`: finished, or nullptr. Both must outlive this.
    ShownMesh(const RefinementMesh& mesh, const Growth* growth) : mesh_(mesh), growth_(growth) {}

    /// Number of vertices.
    [[nodiscard]] std::uint32_t vertices() const
    {
        return growth_ != nullptr ? static_cast<std::uint32_t>(growth_->positions().size())
                                  : mesh_.vertex_count();
    }

    /// Number of triangles.
    [[nodiscard]] std::uint32_t faces() const
    {
        return growth_ != nullptr ? static_cast<std::uint32_t>(growth_->faces().size())
                                  : mesh_.face_count();
    }

    /// Writes all triangles in slot order. Precondition: out.size() >= faces().
    void write_triangles(std::span<Triangle> out) const
    {
        if (growth_ != nullptr)
        {
            std::ranges::transform(growth_->faces(), out.begin(), &GrownFace::vertex);
            return;
        }
        for (const auto range : mesh_.face_ranges())
        {
            for (const Face& face : range)
            {
                out[face.slot] = face.vertex;
            }
        }
    }

    /// Copies it, in the order of slots. Cost: linear.
    [[nodiscard]] LevelMesh copy() const
    {
        return growth_ != nullptr ? level_mesh(growth_->faces(), growth_->positions())
                                  : level_mesh(mesh_);
    }

    /// Position of a vertex on the level's grid.
    [[nodiscard]] std::array<std::int32_t, 3> position(std::uint32_t vertex) const
    {
        if (growth_ != nullptr)
        {
            return growth_->positions()[vertex];
        }
        const Point& point = mesh_.points()[vertex];
        return {
            static_cast<std::int32_t>(point.x),
            static_cast<std::int32_t>(point.y),
            static_cast<std::int32_t>(point.z),
        };
    }

private:
    const RefinementMesh& mesh_;
    const Growth* growth_;
};

}  // namespace vsplit::codec
