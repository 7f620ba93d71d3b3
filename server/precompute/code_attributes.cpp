#include "precompute/code_attributes.h"

#include "codec/octahedron.h"
#include "precompute/wedges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <utility>

namespace vsplit::precompute {
namespace {

/// Fits origin and cell to the values: one cell for all components, which share their unit.
void fit_grid(const SurfaceAttribute& attribute, codec::AttributeInfo& info)
{
    float extent = 0.0F;
    for (std::size_t k = 0; k < info.components; ++k)
    {
        float low = attribute.values.empty() ? 0.0F : attribute.values[k];
        float high = low;
        for (std::size_t i = k; i < attribute.values.size(); i += info.components)
        {
            low = std::min(low, attribute.values[i]);
            high = std::max(high, attribute.values[i]);
        }
        info.origin[k] = low;
        extent = std::max(extent, high - low);
    }
    const auto steps = static_cast<float>((1 << info.bits) - 1);
    info.cell = extent > 0.0F && std::isfinite(extent) ? extent / steps : 1.0F;
}

std::int32_t rounded(double value, std::int32_t most)
{
    return static_cast<std::int32_t>(
        std::floor(std::clamp(value, 0.0, static_cast<double>(most)) + 0.5)
    );
}

void code_color(
    const codec::AttributeInfo& info, std::span<const float> value, std::span<std::int32_t> coded
)
{
    const std::int32_t most = (1 << info.bits) - 1;
    const auto channel = [&](std::size_t k) {
        return rounded(static_cast<double>(value[k]) * most, most);
    };
    if (info.rgb)
    {
        for (std::size_t k = 0; k < value.size(); ++k)
        {
            coded[k] = channel(k);
        }
        return;
    }
    const std::int32_t orange = channel(0) - channel(2);
    const std::int32_t t = channel(2) + (orange >> 1);
    const std::int32_t green = channel(1) - t;
    coded[0] = t + (green >> 1);
    coded[1] = orange;
    coded[2] = green;
    if (value.size() > 3)
    {
        coded[3] = channel(3);
    }
}

void code_normal(std::span<const float> value, int bits, std::span<std::int32_t> coded)
{
    const std::int32_t half = (1 << (bits - 1)) - 1;
    const auto point = codec::octa_point(
        {static_cast<double>(value[0]),
         static_cast<double>(value[1]),
         static_cast<double>(value[2])},
        half
    );
    const auto [u, v] = codec::unfold(point, {2, 1}, half);
    coded[0] = u + half;
    coded[1] = v + half;
}

void code_value(
    const codec::AttributeInfo& info, std::span<const float> value, std::span<std::int32_t> coded
)
{
    const std::int32_t most = (1 << info.bits) - 1;
    if (info.kind == AttributeKind::Color)
    {
        code_color(info, value, coded);
        return;
    }
    if (info.kind == AttributeKind::Normal)
    {
        code_normal(value, info.bits, coded);
        return;
    }
    for (std::size_t k = 0; k < value.size(); ++k)
    {
        const double off = static_cast<double>(value[k]) - static_cast<double>(info.origin[k]);
        coded[k] = rounded(off / static_cast<double>(info.cell), most);
    }
}

/// Rounds all values.
void code_values(const SurfaceAttribute& attribute, CodedAttribute& coded)
{
    const std::size_t numbers = codec::coded_components(coded.info);
    coded.values.resize(attribute.size() * numbers);
    for (std::size_t i = 0; i < attribute.size(); ++i)
    {
        code_value(
            coded.info,
            std::span(attribute.values).subspan(i * attribute.components, attribute.components),
            std::span(coded.values).subspan(i * numbers, numbers)
        );
    }
}

/// About how many bits the differences along the edges take.
std::uint64_t difference_bits(const CodedAttribute& coded)
{
    const std::size_t numbers = codec::coded_components(coded.info);
    std::uint64_t bits = 0;
    for (const auto& [a, b, c] : coded.corners)
    {
        for (std::size_t k = 0; k < numbers; ++k)
        {
            const auto size =
                std::abs(coded.values[a * numbers + k] - coded.values[b * numbers + k]);
            bits += static_cast<std::uint64_t>(std::bit_width(static_cast<std::uint32_t>(size)));
        }
    }
    return bits;
}

/// Makes equal values one.
void merge_equal(CodedAttribute& coded)
{
    const std::size_t numbers = codec::coded_components(coded.info);
    const std::size_t count = coded.values.size() / numbers;
    const auto value = [&](std::size_t i) {
        return std::span(coded.values).subspan(i * numbers, numbers);
    };
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        return std::ranges::lexicographical_compare(value(a), value(b));
    });
    std::vector<std::uint32_t> number(count);
    std::vector<std::int32_t> kept;
    for (std::size_t i = 0; i < count; ++i)
    {
        if (i == 0 || !std::ranges::equal(value(order[i - 1]), value(order[i])))
        {
            kept.insert(kept.end(), value(order[i]).begin(), value(order[i]).end());
        }
        number[order[i]] = static_cast<std::uint32_t>(kept.size() / numbers - 1);
    }
    coded.values = std::move(kept);
    for (Triangle& triangle : coded.corners)
    {
        for (std::uint32_t& corner : triangle)
        {
            corner = number[corner];
        }
    }
}

/// Puts the values of an attribute in the order of the wedges.
std::vector<std::int32_t> by_wedge(const CodedAttribute& coded, const Wedges& wedges)
{
    const std::size_t numbers = codec::coded_components(coded.info);
    std::vector<std::int32_t> values(wedges.count * numbers);
    for (std::size_t f = 0; f < wedges.corners.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto from =
                std::span(coded.values).subspan(coded.corners[f][k] * numbers, numbers);
            std::ranges::copy(
                from, values.begin() + static_cast<std::ptrdiff_t>(wedges.corners[f][k] * numbers)
            );
        }
    }
    return values;
}

}  // namespace

std::uint8_t& bits_of(AttributeBits& bits, AttributeKind kind)
{
    switch (kind)
    {
        case AttributeKind::TexCoord:
            return bits.tex_coord;
        case AttributeKind::Normal:
            return bits.normal;
        case AttributeKind::Color:
            return bits.color;
        default:
            return bits.scalar;
    }
}

Result<CodedAttribute> code_attribute(const SurfaceAttribute& attribute, const AttributeBits& bits)
{
    CodedAttribute coded;
    coded.info.kind = attribute.kind;
    coded.info.set = attribute.set;
    coded.info.components = attribute.components;
    AttributeBits all = bits;
    coded.info.bits = bits_of(all, attribute.kind);
    coded.info.name = attribute.name;
    if (!codec::is_valid(coded.info))
    {
        return fail(
            ErrorCode::UnsupportedInput,
            "an attribute has a number of components or bits that none has"
        );
    }
    if (codec::has_grid(coded.info))
    {
        fit_grid(attribute, coded.info);
    }
    else
    {
        coded.info.cell = 1.0F / static_cast<float>((1 << coded.info.bits) - 1);
    }
    coded.corners = attribute.corners;
    code_values(attribute, coded);
    if (attribute.kind == AttributeKind::Color)
    {
        // Scans and photographs vary in brightness, scales of false colours in one channel at a time.
        CodedAttribute other = coded;
        other.info.rgb = true;
        code_values(attribute, other);
        if (difference_bits(other) < difference_bits(coded))
        {
            coded = std::move(other);
        }
    }
    merge_equal(coded);
    return coded;
}

Result<EncodeInput> make_encode_input(RepairedSurface&& surface, const AttributeBits& bits)
{
    EncodeInput input;
    input.mesh = std::move(surface.repaired.mesh);
    input.stitches = std::move(surface.repaired.stitches);
    if (surface.attributes.empty() && surface.groups.empty())
    {
        return input;
    }
    std::vector<CodedAttribute> coded;
    std::vector<std::span<const Triangle>> tables;
    for (SurfaceAttribute& attribute : surface.attributes)
    {
        auto next = code_attribute(attribute, bits);
        VSPLIT_TRY(next);
        coded.push_back(std::move(*next));
        attribute = {};
    }
    for (const CodedAttribute& attribute : coded)
    {
        tables.emplace_back(attribute.corners);
    }
    input.groups = std::move(surface.groups);
    Wedges wedges = split_wedges(input.mesh, tables, input.groups);
    for (const CodedAttribute& attribute : coded)
    {
        input.attributes.push_back(attribute.info);
        input.values.push_back(by_wedge(attribute, wedges));
    }
    input.wedges = std::move(wedges.corners);
    return input;
}

}  // namespace vsplit::precompute
