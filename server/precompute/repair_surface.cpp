#include "precompute/repair_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr std::uint32_t kNoValue = std::numeric_limits<std::uint32_t>::max();

Result<void> check_attributes(const Surface& surface)
{
    const std::size_t faces = surface.mesh.triangles.size();
    if (!surface.groups.empty() && surface.groups.size() != faces)
    {
        return fail(ErrorCode::BadIndex, "the groups do not cover the triangles");
    }
    for (const SurfaceAttribute& attribute : surface.attributes)
    {
        const bool shaped = attribute.components >= 1 && attribute.components <= 4 &&
                            attribute.values.size() % attribute.components == 0 &&
                            attribute.corners.size() == faces;
        const auto fits = [&](const Triangle& corners) {
            return std::ranges::max(corners) < attribute.size();
        };
        if (!shaped || !std::ranges::all_of(attribute.corners, fits))
        {
            return fail(ErrorCode::BadIndex, "the attributes do not fit the triangles");
        }
    }
    return {};
}

/// For every value the first one that has the same bytes.
std::vector<std::uint32_t> first_equals(const SurfaceAttribute& attribute)
{
    const auto bits = [&](std::uint32_t value, std::size_t i) {
        return std::bit_cast<std::uint32_t>(attribute.values[value * attribute.components + i]);
    };
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        for (std::size_t i = 0; i < attribute.components; ++i)
        {
            if (bits(a, i) != bits(b, i))
            {
                return bits(a, i) < bits(b, i) ? -1 : 1;
            }
        }
        return 0;
    };
    std::vector<std::uint32_t> order(attribute.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const int sign = compare(a, b);
        return sign != 0 ? sign < 0 : a < b;
    });
    std::vector<std::uint32_t> first(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        const bool repeats = i > 0 && compare(order[i], order[i - 1]) == 0;
        first[order[i]] = repeats ? first[order[i - 1]] : order[i];
    }
    return first;
}

void follow_faces(SurfaceAttribute& attribute, const RepairedMesh& repaired)
{
    std::vector<Triangle> corners;
    corners.reserve(repaired.source_faces.size());
    for (std::size_t face = 0; face < repaired.source_faces.size(); ++face)
    {
        const auto& [a, b, c] = attribute.corners[repaired.source_faces[face]];
        corners.push_back(repaired.turned[face] != 0 ? Triangle{a, c, b} : Triangle{a, b, c});
    }
    attribute.corners = std::move(corners);
}

/// Returns how many numbers were not finite.
std::size_t zero_what_is_not_finite(SurfaceAttribute& attribute)
{
    std::size_t count = 0;
    for (float& value : attribute.values)
    {
        count += std::isfinite(value) ? 0 : 1;
        value = std::isfinite(value) ? value : 0.0F;
    }
    return count;
}

}  // namespace

void merge_values(SurfaceAttribute& attribute)
{
    const std::vector<std::uint32_t> first = first_equals(attribute);
    std::vector<std::uint32_t> renumbered(first.size(), kNoValue);
    std::vector<float> values;
    std::uint32_t count = 0;
    for (Triangle& corners : attribute.corners)
    {
        for (std::uint32_t& value : corners)
        {
            const std::uint32_t old = first[value];
            if (renumbered[old] == kNoValue)
            {
                renumbered[old] = count++;
                const auto begin =
                    attribute.values.begin() + old * std::ptrdiff_t{attribute.components};
                values.insert(values.end(), begin, begin + attribute.components);
            }
            value = renumbered[old];
        }
    }
    attribute.values = std::move(values);
}

Result<RepairedSurface> repair_surface(const Surface& surface, std::span<const float> importance)
{
    VSPLIT_TRY(check_attributes(surface));
    auto repaired = repair_mesh(surface.mesh, importance);
    if (!repaired)
    {
        return tl::unexpected<Error>(repaired.error());
    }
    RepairedSurface result;
    result.repaired = std::move(*repaired);
    result.attributes = surface.attributes;
    for (SurfaceAttribute& attribute : result.attributes)
    {
        const std::size_t bad = zero_what_is_not_finite(attribute);
        if (bad > 0)
        {
            result.dropped.push_back(
                std::to_string(bad) + " attribute values that are not finite (now 0)"
            );
        }
        follow_faces(attribute, result.repaired);
        merge_values(attribute);
    }
    if (!surface.groups.empty())
    {
        for (const std::uint32_t face : result.repaired.source_faces)
        {
            result.groups.push_back(surface.groups[face]);
        }
    }
    return result;
}

}  // namespace vsplit::precompute
