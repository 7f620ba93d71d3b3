#include "precompute/corner_table.h"

#include "precompute/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr std::uint32_t kNoValue = std::numeric_limits<std::uint32_t>::max();

std::uint32_t index_of(std::int64_t value)
{
    return value >= 0 && value < kNoValue ? static_cast<std::uint32_t>(value) : kNoValue;
}

}  // namespace

float to_float(double value)
{
    constexpr double kLargest = std::numeric_limits<float>::max();
    const bool fits = std::abs(value) <= kLargest;
    return fits ? static_cast<float>(value) : std::numeric_limits<float>::infinity();
}

CornerTable::CornerTable(AttributeKind kind, std::uint8_t components)
{
    attribute_.kind = kind;
    attribute_.components = components;
}

std::int64_t CornerTable::add_value(std::span<const float> value)
{
    attribute_.values.insert(attribute_.values.end(), value.begin(), value.end());
    return static_cast<std::int64_t>(value_count()) - 1;
}

void CornerTable::add_polygon(std::span<const std::int64_t> values)
{
    used_ = used_ || std::ranges::any_of(values, [](std::int64_t value) { return value >= 0; });
    const auto add = [&](std::size_t i, std::size_t j, std::size_t k) -> Result<void> {
        attribute_.corners.push_back({index_of(values[i]), index_of(values[j]), index_of(values[k])}
        );
        return {};
    };
    (void)for_each_fan_triangle(values.size(), add);  // cannot fail
}

void CornerTable::pad(std::size_t triangles)
{
    if (triangles > attribute_.corners.size())
    {
        attribute_.corners.resize(triangles, {kNoValue, kNoValue, kNoValue});
    }
}

SurfaceAttribute CornerTable::finish(
    std::size_t triangles, std::span<const float> missing, std::size_t& bad_corners
)
{
    pad(triangles);
    attribute_.corners.resize(triangles);
    const auto known = static_cast<std::uint32_t>(value_count());
    bad_corners = 0;
    std::optional<std::uint32_t> filler;
    for (Triangle& corners : attribute_.corners)
    {
        for (std::uint32_t& value : corners)
        {
            if (value < known)
            {
                continue;
            }
            bad_corners += value == kNoValue ? 0 : 1;
            filler = filler.value_or(static_cast<std::uint32_t>(value_count()));
            if (*filler == value_count())
            {
                add_value(missing.first(attribute_.components));
            }
            value = *filler;
        }
    }
    return std::exchange(attribute_, {});
}

}  // namespace vsplit::precompute
