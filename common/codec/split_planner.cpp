#include "codec/split_planner.h"

#include <vector>

namespace vsplit::codec {
namespace {

/// Finds the corner at which a wedge begins: the one before `right` at the vertex of `some`.
Corner find_wedge(const RefinementMesh& mesh, std::uint32_t right, Corner some)
{
    const auto found = [&](Corner corner) { return mesh.vertex(next_corner(corner)) == right; };
    Corner corner = some;
    do
    {
        if (found(corner))
        {
            return corner;
        }
        const Corner across = mesh.opposite(next_corner(corner));
        corner = across < 0 ? -1 : next_corner(across);
    }
    while (corner >= 0 && corner != some);
    corner = corner < 0 ? some : -1;
    while (corner >= 0 && !found(corner))
    {
        const Corner across = mesh.opposite(previous_corner(corner));
        corner = across < 0 ? -1 : previous_corner(across);
    }
    return corner;
}

}  // namespace

Result<SplitPlan> plan_splits(
    const RefinementMesh& mesh,
    std::span<const std::uint32_t> place,
    std::span<const Collapse> batch
)
{
    std::vector<Corner> corner_of(mesh.vertex_count(), -1);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    {
        for (Corner k = 0; k < 3; ++k)
        {
            corner_of[mesh.vertex(static_cast<Corner>(f) * 4 + k)] = static_cast<Corner>(f) * 4 + k;
        }
    }
    SplitPlan plan;
    plan.split_of_face.assign(mesh.face_count(), SplitPlan::kNoSplit);
    for (const Collapse& collapse : batch)
    {
        Split split;
        split.first = find_wedge(mesh, place[collapse.right], corner_of[place[collapse.kept]]);
        split.wedge = collapse.wedge;
        split.kind = collapse.kind;
        Corner corner = split.first;
        for (int i = 0; i < split.wedge; ++i)
        {
            if (corner < 0 || plan.split_of_face[static_cast<std::size_t>(face_of(corner))] !=
                                  SplitPlan::kNoSplit)
            {
                return fail(ErrorCode::Internal, "a level's collapses are not independent");
            }
            plan.split_of_face[static_cast<std::size_t>(face_of(corner))] =
                static_cast<std::uint32_t>(plan.splits.size());
            const Corner across = mesh.opposite(next_corner(corner));
            corner = across < 0 ? -1 : next_corner(across);
        }
        plan.splits.push_back(split);
    }
    return plan;
}

}  // namespace vsplit::codec
