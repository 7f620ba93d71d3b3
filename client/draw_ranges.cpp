#include "draw_ranges.h"

#include <utility>
#include <vector>

namespace vsplit::client {
namespace {

// Which range a triangle of a group goes to: keys 0 .. materials are the opaque ones' (0: none), what
// follows is one key for every group.
class RangeKeys
{
public:
    explicit RangeKeys(const Appearance* appearance)
    {
        if (appearance == nullptr)
        {
            return;
        }
        materials_ = appearance->materials.size();
        for (const FaceGroup& group : appearance->groups)
        {
            const auto material = static_cast<std::size_t>(group.material);
            const bool known = group.material >= 0 && material < materials_;
            group_materials_.push_back(known ? group.material : -1);
            const bool blended =
                known && appearance->materials[material].alpha_mode == AlphaMode::Blend;
            const std::size_t key = blended ? materials_ + group_materials_.size()
                                    : known ? material + 1
                                            : 0;
            group_keys_.push_back(key);
        }
    }

    std::size_t count() const { return materials_ + 1 + group_keys_.size(); }

    std::size_t key(std::uint32_t group) const
    {
        return group < group_keys_.size() ? group_keys_[group] : 0;
    }

    bool blended(std::size_t key) const { return key > materials_; }

    std::int32_t material(std::size_t key) const
    {
        return blended(key) ? group_materials_[key - materials_ - 1]
                            : static_cast<std::int32_t>(key) - 1;
    }

private:
    std::size_t materials_ = 0;
    std::vector<std::size_t> group_keys_;
    std::vector<std::int32_t> group_materials_;
};

std::array<float, 3> mean_corner(const SurfaceArrays& arrays, const DrawRange& range)
{
    std::array<double, 3> sum{};
    for (std::uint32_t t = range.first; t < range.first + range.count; ++t)
    {
        for (const std::uint32_t wedge : arrays.triangles[t])
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                sum[axis] += arrays.positions[wedge][axis];
            }
        }
    }
    const double share = 1.0 / (3.0 * range.count);
    return {
        static_cast<float>(sum[0] * share),
        static_cast<float>(sum[1] * share),
        static_cast<float>(sum[2] * share)};
}

}  // namespace

void sort_by_material(
    SurfaceArrays& arrays, std::span<const std::uint32_t> groups, const Appearance* appearance
)
{
    const RangeKeys keys(appearance);
    const auto key_of = [&](std::size_t triangle) {
        return keys.key(triangle < groups.size() ? groups[triangle] : 0);
    };
    std::vector<std::uint32_t> starts(keys.count() + 1);
    for (std::size_t t = 0; t < arrays.triangles.size(); ++t)
    {
        ++starts[key_of(t) + 1];
    }
    for (std::size_t key = 0; key < keys.count(); ++key)
    {
        const std::uint32_t count = starts[key + 1];
        starts[key + 1] = starts[key] + count;
        if (count > 0)
        {
            arrays.ranges.push_back({keys.material(key), starts[key], count, {}});
        }
    }
    std::vector<Triangle> sorted(arrays.triangles.size());
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for (std::size_t t = 0; t < arrays.triangles.size(); ++t)
    {
        sorted[next[key_of(t)]++] = arrays.triangles[t];
    }
    arrays.triangles = std::move(sorted);
    for (DrawRange& range : arrays.ranges)
    {
        range.centre = mean_corner(arrays, range);
    }
}

}  // namespace vsplit::client
