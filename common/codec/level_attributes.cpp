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

/// Turns brightness and two differences back into red, green and blue.
/// Source: Malvar, Sullivan, "YCoCg-R: A Color Space with RGB Reversibility and Low Dynamic Range", 2003.
void write_color(
    const AttributeInfo& info, std::span<const std::int32_t> coded, std::span<float> out
)
{
    if (info.rgb)
    {
        std::ranges::transform(coded, out.begin(), [&](std::int32_t number) {
            return static_cast<float>(number) * info.cell;
        });
        return;
    }
    const float cell = info.cell;
    const std::int32_t t = coded[0] - (coded[2] >> 1);
    const std::int32_t green = coded[2] + t;
    const std::int32_t blue = t - (coded[1] >> 1);
    const std::int32_t red = blue + coded[1];
    const float most = 1.0F;
    out[0] = std::clamp(static_cast<float>(red) * cell, 0.0F, most);
    out[1] = std::clamp(static_cast<float>(green) * cell, 0.0F, most);
    out[2] = std::clamp(static_cast<float>(blue) * cell, 0.0F, most);
    if (coded.size() > 3)
    {
        out[3] = static_cast<float>(coded[3]) * cell;
    }
}

}  // namespace

bool is_valid(const AttributeInfo& info)
{
    const bool bits = info.bits >= 1 && info.bits <= kMaxAttributeBits &&
                      (!info.rgb || info.kind == AttributeKind::Color);
    switch (info.kind)
    {
        case AttributeKind::TexCoord:
            return bits && info.components == 2;
        case AttributeKind::Normal:
            return bits && info.bits >= 2 && info.components == 3;
        case AttributeKind::Color:
            return bits && (info.components == 3 || info.components == 4);
        case AttributeKind::Scalar:
            return bits && info.components >= 1 && info.components <= 4;
    }
    return false;
}

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
        if (info.kind == AttributeKind::Color)
        {
            write_color(info, value, target);
            continue;
        }
        for (std::size_t k = 0; k < numbers; ++k)
        {
            target[k] = info.origin[k] + static_cast<float>(value[k]) * info.cell;
        }
    }
}

}  // namespace vsplit::codec
