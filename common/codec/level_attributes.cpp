#include "codec/level_attributes.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace vsplit::codec {
namespace {

/// Writes the unit vector that a point of the octahedron's unfolded surface stands for.
/// Source: Meyer, Suessmuth, Sussner, Stamminger, Greiner, "On Floating-Point Normal Vectors", 2010.
void write_normal(std::span<const std::int32_t> coded, int bits, std::span<float> out)
{
    const float half = static_cast<float>((1 << bits) - 2) / 2.0F;
    const float u = static_cast<float>(coded[0]) / half - 1.0F;
    const float v = static_cast<float>(coded[1]) / half - 1.0F;
    float x = u;
    float y = v;
    const float z = 1.0F - std::abs(u) - std::abs(v);
    if (z < 0.0F)
    {
        x = std::copysign(1.0F - std::abs(v), u);
        y = std::copysign(1.0F - std::abs(u), v);
    }
    const float length = std::sqrt(x * x + y * y + z * z);
    out[0] = x / length;
    out[1] = y / length;
    out[2] = z / length;
}

}  // namespace

void write_values(
    const AttributeInfo& info, std::span<const std::int32_t> coded, std::span<float> out
)
{
    const std::size_t numbers = coded_components(info);
    const std::size_t count = coded.size() / numbers;
    VSPLIT_ASSERT(out.size() >= count * info.components);
    for (std::size_t i = 0; i < count; ++i)
    {
        const auto value = coded.subspan(i * numbers, numbers);
        const auto target = out.subspan(i * info.components, info.components);
        if (info.kind == AttributeKind::Normal)
        {
            write_normal(value, info.bits, target);
            continue;
        }
        for (std::size_t k = 0; k < numbers; ++k)
        {
            target[k] = info.origin[k] + static_cast<float>(value[k]) * info.cell;
        }
    }
}

}  // namespace vsplit::codec
