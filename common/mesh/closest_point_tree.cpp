// Based on: Ericson, "Real-Time Collision Detection", 2005, sections 5.1.5 (closest point on a
// triangle) and 6.2 (top-down bounding-volume hierarchies); Wald, Benthin, Boulos, "Getting Rid of
// Packets: Efficient SIMD Single-Ray Traversal using Multi-branching BVHs", 2008 (four children a
// node, tested at once).
#include "mesh/closest_point_tree.h"

#include "core/assert.h"
#include "mesh/triangle_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vsplit {
namespace {

using Point = std::array<float, 3>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Deep enough for 2^31 leaves: each visited node leaves at most three siblings on the stack.
constexpr std::size_t kStackSize = 64;

Point subtract(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

struct Visit
{
    float squared_distance;
    std::uint32_t child;
};

/// Nearest box last, so that it is popped first.
void sort_farthest_first(std::span<Visit> visits)
{
    for (std::size_t i = 1; i < visits.size(); ++i)
    {
        for (std::size_t j = i;
             j > 0 && visits[j - 1].squared_distance < visits[j].squared_distance;
             --j)
        {
            std::swap(visits[j - 1], visits[j]);
        }
    }
}

}  // namespace

ClosestPointTree::ClosestPointTree(
    std::span<const std::array<float, 3>> positions, std::span<const Triangle> triangles
)
{
    VSPLIT_ASSERT(!triangles.empty());
    fit_to_box(positions);
    positions_.resize(positions.size());
    std::ranges::transform(positions, positions_.begin(), [this](const Point& point) {
        return normalised(point);
    });
    std::vector<Item> items(triangles.size());
    for (std::uint32_t i = 0; i < items.size(); ++i)
    {
        const Point& a = positions_[triangles[i][0]];
        const Point& b = positions_[triangles[i][1]];
        const Point& c = positions_[triangles[i][2]];
        items[i] = {{a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]}, i};
    }
    leaf_of_triangle_.resize(triangles.size());
    leaves_.reserve((triangles.size() + kWidth - 1) / kWidth);
    nodes_.reserve(leaves_.capacity() / 2 + 1);
    nodes_.emplace_back();
    build_node(triangles, items, 0);
}

/// Fourth powers of lengths occur below; at unit size they neither overflow nor vanish, whatever the
/// model's unit is. A power of two changes no mantissa.
void ClosestPointTree::fit_to_box(std::span<const std::array<float, 3>> positions)
{
    Point low{kInfinity, kInfinity, kInfinity};
    Point high{-kInfinity, -kInfinity, -kInfinity};
    for (const Point& point : positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    }
    float extent = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        centre_[axis] = 0.5F * low[axis] + 0.5F * high[axis];
        extent = std::max(extent, 0.5F * high[axis] - 0.5F * low[axis]);
    }
    if (extent > 0.0F && std::isfinite(extent))
    {
        int exponent = 0;
        static_cast<void>(std::frexp(extent, &exponent));
        scale_ = std::ldexp(1.0F, std::clamp(-exponent, -126, 126));
    }
}

std::array<float, 3> ClosestPointTree::normalised(const std::array<float, 3>& point) const
{
    const Point offset = subtract(point, centre_);
    return {offset[0] * scale_, offset[1] * scale_, offset[2] * scale_};
}

/// Sorts the items about the median of their longest axis and returns how many belong to the first
/// half: a multiple of the leaf size, so that all leaves but one are full.
std::size_t ClosestPointTree::split_leaves(std::span<Item> items)
{
    const std::size_t leaf_count = (items.size() + kWidth - 1) / kWidth;
    if (leaf_count <= 1)
    {
        return items.size();
    }
    Point low = items.front().centroid;
    Point high = low;
    for (const Item& item : items)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], item.centroid[axis]);
            high[axis] = std::max(high[axis], item.centroid[axis]);
        }
    }
    const Point extent = subtract(high, low);
    const auto axis =
        static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
    const std::size_t first = leaf_count / 2 * kWidth;
    // Equal centroids are told apart by index, so that every standard library builds the same tree.
    const auto before = [axis](const Item& a, const Item& b) {
        return a.centroid[axis] != b.centroid[axis] ? a.centroid[axis] < b.centroid[axis]
                                                    : a.triangle < b.triangle;
    };
    const auto middle = items.begin() + static_cast<std::ptrdiff_t>(first);
    std::nth_element(items.begin(), middle, items.end(), before);
    return first;
}

ClosestPointTree::Box ClosestPointTree::build_node(
    std::span<const Triangle> triangles, std::span<Item> items, std::uint32_t node
)
{
    const std::size_t half = split_leaves(items);
    const auto left = items.first(half);
    const auto right = items.subspan(half);
    const std::size_t quarter = split_leaves(left);
    const std::size_t three_quarters = right.empty() ? 0 : split_leaves(right);
    const std::array<std::span<Item>, kWidth> parts{
        left.first(quarter),
        left.subspan(quarter),
        right.first(three_quarters),
        right.subspan(three_quarters),
    };
    Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::size_t lane = 0; lane < kWidth; ++lane)
    {
        const Box part = build_child(triangles, parts[lane], node, lane);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            nodes_[node].low[axis][lane] = part.low[axis];
            nodes_[node].high[axis][lane] = part.high[axis];
            box.low[axis] = std::min(box.low[axis], part.low[axis]);
            box.high[axis] = std::max(box.high[axis], part.high[axis]);
        }
    }
    return box;
}

ClosestPointTree::Box ClosestPointTree::build_child(
    std::span<const Triangle> triangles, std::span<Item> items, std::uint32_t node, std::size_t lane
)
{
    if (items.empty())
    {
        return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    }
    if (items.size() <= kWidth)
    {
        const auto leaf = static_cast<std::uint32_t>(leaves_.size());
        leaves_.emplace_back();
        nodes_[node].child[lane] = leaf | kLeafBit;
        return build_leaf(triangles, items, leaf);
    }
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_[node].child[lane] = child;
    return build_node(triangles, items, child);
}

ClosestPointTree::Box ClosestPointTree::build_leaf(
    std::span<const Triangle> triangles, std::span<const Item> items, std::uint32_t leaf
)
{
    Leaf& target = leaves_[leaf];
    Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::size_t lane = 0; lane < kWidth; ++lane)
    {
        // A leaf with fewer triangles repeats its last one.
        const std::uint32_t index = items[std::min(lane, items.size() - 1)].triangle;
        target.corners[lane] = triangles[index];
        target.triangle[lane] = index;
        leaf_of_triangle_[index] = leaf;
        for (const std::uint32_t corner : triangles[index])
        {
            const Point& point = positions_[corner];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                box.low[axis] = std::min(box.low[axis], point[axis]);
                box.high[axis] = std::max(box.high[axis], point[axis]);
            }
        }
    }
    return box;
}

void ClosestPointTree::closest_in_leaf(
    const Leaf& leaf, const std::array<float, 3>& point, Hit& best
) const
{
    const auto corner = [&](std::size_t k) {
        std::array<Lanes, 3> lists{};
        for (std::size_t lane = 0; lane < kWidth; ++lane)
        {
            const Point& position = positions_[leaf.corners[lane][k]];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                lists[axis][lane] = position[axis];
            }
        }
        return lanes::load(lists);
    };
    const lanes::Vector4 a = corner(0);
    const lanes::Vector4 ab = corner(1) - a;
    const lanes::Vector4 ac = corner(2) - a;
    const lanes::Float4 squared =
        lanes::squared_distance(lanes::splat(point) - a, ab, ac, lanes::invert(ab, ac));
    const Lanes distances = lanes::store(squared);
    for (std::size_t lane = 0; lane < kWidth; ++lane)
    {
        if (distances[lane] < best.squared_distance)
        {
            best = {distances[lane], leaf.triangle[lane]};
        }
    }
}

float ClosestPointTree::squared_distance(const std::array<float, 3>& point, std::uint32_t& hint)
    const
{
    using lanes::Float4;
    const Point query = normalised(point);
    const std::uint32_t hinted = hint < leaf_of_triangle_.size() ? hint : 0;
    Hit best{kInfinity, hinted};
    closest_in_leaf(leaves_[leaf_of_triangle_[hinted]], query, best);

    const lanes::Vector4 position = lanes::splat(query);
    const Float4 zero = lanes::splat(0.0F);
    std::array<Visit, kStackSize> stack;
    std::size_t depth = 0;
    stack[depth++] = {0.0F, 0};
    while (depth > 0)
    {
        const Visit visit = stack[--depth];
        if (visit.squared_distance >= best.squared_distance)
        {
            continue;
        }
        if ((visit.child & kLeafBit) != 0)
        {
            closest_in_leaf(leaves_[visit.child & ~kLeafBit], query, best);
            continue;
        }
        const Node& node = nodes_[visit.child];
        const lanes::Vector4 below = lanes::load(node.low) - position;
        const lanes::Vector4 above = position - lanes::load(node.high);
        const lanes::Vector4 gap{
            lanes::max(lanes::max(below.x, above.x), zero),
            lanes::max(lanes::max(below.y, above.y), zero),
            lanes::max(lanes::max(below.z, above.z), zero),
        };
        const Lanes squared = lanes::store(dot(gap, gap));
        const std::size_t first = depth;
        for (std::size_t lane = 0; lane < kWidth; ++lane)
        {
            if (squared[lane] < best.squared_distance)
            {
                stack[depth++] = {squared[lane], node.child[lane]};
            }
        }
        sort_farthest_first(std::span(stack).subspan(first, depth - first));
    }
    hint = best.triangle;
    return best.squared_distance / scale_ / scale_;
}

}  // namespace vsplit
