// Based on: Hoppe, "Smooth View-Dependent Level-of-Detail Control and its Application to Terrain
// Rendering", 1998 and Popovic, Hoppe, "Progressive Simplicial Complexes", 1997 (components must be able to
// vanish, or the base keeps all of them). Departure: a component comes as a whole, since what is smaller than
// the triangles around it has no coarser shape worth showing.
#include "precompute/part_schedule.h"

#include "codec/small_base_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vsplit::precompute {
namespace {

/// Size of a component, in lengths of a typical edge, below which it leaves.
constexpr double kVisibleEdges = 1.0;

/// Share of the vertices that is worth a level of its own.
constexpr double kLeastShare = 0.03;

/// Share of the vertices that leaves when collapses are stuck.
constexpr double kStuckShare = 0.25;

/// Vertices that a base has room for: about 1.5 kB. Larger ones must shrink, whatever that costs.
constexpr std::size_t kLargeBase = 800;

/// Vertices of a base to aim for when there are several components, and the least share of the mesh that they
/// may be. Measured: fewer show a crowd of single triangles and cost no less in the end.
constexpr std::size_t kBaseGoal = 300;
constexpr std::size_t kVerticesPerBaseVertex = 16;

/// Sets with the least member as representative.
class DisjointSets
{
public:
    explicit DisjointSets(std::size_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
    }

    std::uint32_t find(std::uint32_t member)
    {
        while (parent_[member] != member)
        {
            parent_[member] = parent_[parent_[member]];
            member = parent_[member];
        }
        return member;
    }

    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    /// Numbers the sets from 0 on. Result: by member its set; `count`: how many there are.
    std::vector<std::uint32_t> number(std::size_t& count)
    {
        std::vector<std::uint32_t> numbers(parent_.size());
        count = 0;
        for (std::uint32_t member = 0; member < parent_.size(); ++member)
        {
            const std::uint32_t first = find(member);
            numbers[member] =
                first == member ? static_cast<std::uint32_t>(count++) : numbers[first];
        }
        return numbers;
    }

private:
    std::vector<std::uint32_t> parent_;
};

double area_of(std::span<const Vector3> points, const Triangle& triangle)
{
    const Vector3 normal =
        cross(points[triangle[1]] - points[triangle[0]], points[triangle[2]] - points[triangle[0]]);
    return 0.5 * std::sqrt(dot(normal, normal));
}

}  // namespace

PartSchedule::PartSchedule(
    std::span<const Vector3> exact,
    std::span<const Triangle> triangles,
    std::span<const std::uint32_t> stitches,
    std::span<const float> importance
)
    : exact_(exact), triangles_(triangles), importance_(importance)
{
    DisjointSets sets(exact.size());
    for (const auto& [a, b, c] : triangles)
    {
        sets.join(a, b);
        sets.join(a, c);
    }
    components_ = sets.number(component_count_);
    if (!has_parts())
    {
        components_ = {};
        return;
    }
    for (std::uint32_t v = 0; v < stitches.size(); ++v)
    {
        sets.join(v, stitches[v]);
    }
    std::size_t count = 0;
    group_of_ = sets.number(count);
    tied_ = count < component_count_;
    groups_.resize(count);
    measure_groups();
}

void PartSchedule::measure_groups()
{
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::vector<std::array<Vector3, 2>> boxes(
        groups_.size(), {Vector3{kFar, kFar, kFar}, Vector3{-kFar, -kFar, -kFar}}
    );
    for (std::uint32_t v = 0; v < exact_.size(); ++v)
    {
        auto& [low, high] = boxes[group_of_[v]];
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], exact_[v][axis]);
            high[axis] = std::max(high[axis], exact_[v][axis]);
        }
        Group& group = groups_[group_of_[v]];
        group.kept = group.kept || (!importance_.empty() && importance_[v] > 0.0F);
        group.present = true;
    }
    for (const Triangle& triangle : triangles_)
    {
        groups_[group_of_[triangle[0]]].area += area_of(exact_, triangle);
    }
    for (std::size_t g = 0; g < groups_.size(); ++g)
    {
        const Vector3 diagonal = boxes[g][1] - boxes[g][0];
        groups_[g].size =
            std::sqrt(std::sqrt(dot(diagonal, diagonal)) * std::sqrt(groups_[g].area));
    }
    by_size_.resize(groups_.size());
    std::iota(by_size_.begin(), by_size_.end(), std::uint32_t{0});
    std::ranges::stable_sort(by_size_, {}, [this](std::uint32_t g) { return groups_[g].size; });
    groups_[by_size_.back()].kept = true;
}

void PartSchedule::count_present(const CollapseMesh& mesh)
{
    for (Group& group : groups_)
    {
        group.vertices = 0;
        group.faces = 0;
    }
    for (std::uint32_t v = 0; v < exact_.size(); ++v)
    {
        groups_[group_of_[v]].vertices += mesh.is_removed(v) ? 0U : 1U;
    }
    for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    {
        groups_[group_of_[triangles_[f][0]]].faces += mesh.has_face(f) ? 1U : 0U;
    }
    for (Group& group : groups_)
    {
        group.present = group.faces > 0;
    }
}

std::vector<std::uint8_t> PartSchedule::choose(std::size_t vertices, std::size_t goal, bool stuck)
    const
{
    double area = 0.0;
    for (const Group& group : groups_)
    {
        area += group.present ? group.area : 0.0;
    }
    const double edge = kVisibleEdges * std::sqrt(area / static_cast<double>(vertices));
    const auto share = static_cast<std::size_t>(kStuckShare * static_cast<double>(vertices));
    const bool forced = stuck && vertices > kLargeBase;
    const std::size_t wanted =
        forced ? std::min(vertices - kLargeBase, std::max<std::size_t>(share, 1)) : 0;
    std::vector<std::uint8_t> leaves(groups_.size(), 0);
    std::size_t taken = 0;
    for (const std::uint32_t g : by_size_)
    {
        const Group& group = groups_[g];
        const bool fits = group.vertices <= codec::kMaxSmallBaseVertices &&
                          group.faces <= codec::kMaxSmallBaseFaces * group.vertices;
        const bool may = group.present && !group.kept && fits;
        if (may && (group.size < edge || taken < wanted) &&
            vertices - taken >= goal + group.vertices)
        {
            leaves[g] = 1;
            taken += group.vertices;
        }
    }
    const bool pays = taken > 0 && (stuck || static_cast<double>(taken) >=
                                                 kLeastShare * static_cast<double>(vertices));
    return pays ? leaves : std::vector<std::uint8_t>{};
}

RemovedParts PartSchedule::remove(CollapseMesh& mesh, std::span<const std::uint8_t> leaves) const
{
    // Groups in the order of their first faces, so that neighbours are coded one after the other.
    std::vector<std::uint32_t> order;
    std::vector<std::vector<Triangle>> triangles(groups_.size());
    for (std::uint32_t f = 0; f < triangles_.size(); ++f)
    {
        const std::uint32_t g = group_of_[triangles_[f][0]];
        if (leaves[g] != 0 && mesh.has_face(f))
        {
            if (triangles[g].empty())
            {
                order.push_back(g);
            }
            triangles[g].push_back(mesh.triangle(f));
        }
    }
    RemovedParts parts;
    std::size_t vertices = codec::kMaxSmallBaseVertices;
    for (const std::uint32_t g : order)
    {
        vertices += groups_[g].vertices;
        if (vertices > codec::kMaxSmallBaseVertices)
        {
            parts.emplace_back();
            vertices = groups_[g].vertices;
        }
        parts.back().insert(parts.back().end(), triangles[g].begin(), triangles[g].end());
    }
    for (const std::vector<Triangle>& part : parts)
    {
        mesh.remove_parts(part);
    }
    return parts;
}

std::size_t PartSchedule::base_goal(std::size_t goal) const
{
    return has_parts() ? std::max(goal, std::min(kBaseGoal, exact_.size() / kVerticesPerBaseVertex))
                       : goal;
}

bool PartSchedule::is_base(std::size_t vertices) const
{
    return has_parts() && vertices <= kLargeBase;
}

RemovedParts PartSchedule::take(
    CollapseMesh& mesh, std::size_t vertices, std::size_t goal, bool stuck
)
{
    if (!has_parts() || vertices <= goal)
    {
        return {};
    }
    count_present(mesh);
    auto leaves = choose(vertices, goal, stuck);
    if (leaves.empty() && stuck && tied_ && vertices > kLargeBase)
    {
        tied_ = false;
        group_of_ = components_;
        groups_.assign(component_count_, {});
        measure_groups();
        count_present(mesh);
        leaves = choose(vertices, goal, stuck);
    }
    return leaves.empty() ? RemovedParts{} : remove(mesh, leaves);
}

}  // namespace vsplit::precompute
