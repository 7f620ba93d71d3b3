#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/collapse_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Components that leave a mesh together, as groups for one Parts chunk each.
using RemovedParts = std::vector<std::vector<Triangle>>;

/// Decides when components leave a mesh that is made coarser: as soon as they are smaller than its
/// triangles, the smallest first; where collapses find nothing more to do, before that. Components that
/// share vertices of the source (cut copies) leave together, unless that would keep a large base. The largest
/// one stays, and so does what the publisher wants to keep. Not thread safe.
class PartSchedule
{
public:
    /// Looks at the complete mesh. `exact`: V points, grid units; `triangles`: in them; `stitches`: by
    /// vertex the one that it is a copy of, or empty; `importance`: V numbers, above 0 for what is to be kept,
    /// or empty. Cost: linear.
    PartSchedule(
        std::span<const Vector3> exact,
        std::span<const Triangle> triangles,
        std::span<const std::uint32_t> stitches,
        std::span<const float> importance
    );

    /// True when there is more than one component and they may leave.
    [[nodiscard]] bool has_parts() const { return component_count_ > 1; }

    /// From now on no component leaves.
    void keep_all()
    {
        component_count_ = 1;
        components_ = {};
    }

    /// By vertex the number of its component; empty when none leaves.
    [[nodiscard]] std::span<const std::uint32_t> components() const { return components_; }

    /// Vertices of the base to aim for. `goal`: the same for a mesh of one component.
    [[nodiscard]] std::size_t base_goal(std::size_t goal) const;

    /// True when a mesh of several components may end as a base of so many vertices rather than lose the
    /// shape of those that it has.
    [[nodiscard]] bool is_base(std::size_t vertices) const;

    /// Takes out of `mesh` what is too small for it. `vertices`: of the mesh now; `goal`: to which it
    /// shall come down; `stuck`: collapses do not bring it there. Result: what was taken out, as it was;
    /// empty when it is not worth a level. Cost: linear in the complete mesh.
    [[nodiscard]] RemovedParts take(
        CollapseMesh& mesh, std::size_t vertices, std::size_t goal, bool stuck
    );

private:
    /// Components that leave together.
    struct Group
    {
        double size = 0.0;  ///< Between diameter and square root of the area.
        double area = 0.0;
        bool kept = false;           ///< Never leaves.
        bool present = false;        ///< Has not left.
        std::uint32_t vertices = 0;  ///< Of the mesh as it is now.
        std::uint32_t faces = 0;
    };

    void measure_groups();
    void count_present(const CollapseMesh& mesh);
    [[nodiscard]] std::vector<std::uint8_t> choose(
        std::size_t vertices, std::size_t goal, bool stuck
    ) const;
    [[nodiscard]] RemovedParts remove(CollapseMesh& mesh, std::span<const std::uint8_t> leaves)
        const;

    std::span<const Vector3> exact_;
    std::span<const Triangle> triangles_;
    std::span<const float> importance_;
    std::vector<std::uint32_t> components_;  ///< By vertex.
    std::size_t component_count_ = 0;
    std::vector<std::uint32_t> group_of_;  ///< By vertex.
    std::vector<Group> groups_;
    std::vector<std::uint32_t> by_size_;  ///< Groups, smallest first.
    bool tied_ = false;                   ///< Copies leave together.
};

}  // namespace vsplit::precompute
