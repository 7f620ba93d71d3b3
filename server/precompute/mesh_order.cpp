// Based on: Morton, "A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing",
// 1966 (the curve).
#include "precompute/mesh_order.h"

#include <algorithm>
#include <utility>

namespace vsplit::precompute {
namespace {

using Point = std::array<double, 3>;

/// Bits per axis; three of them fit 64.
constexpr int kBits = 20;

/// Spreads the low 20 bits of a number to every third bit.
std::uint64_t spread_bits(std::uint64_t value)
{
    value = (value | (value << 32)) & 0x001F'0000'0000'FFFFULL;
    value = (value | (value << 16)) & 0x001F'0000'FF00'00FFULL;
    value = (value | (value << 8)) & 0x100F'00F0'0F00'F00FULL;
    value = (value | (value << 4)) & 0x10C3'0C30'C30C'30C3ULL;
    return (value | (value << 2)) & 0x1249'2492'4924'9249ULL;
}

std::uint64_t morton_code(const Point& point, const Point& low, double scale)
{
    constexpr auto kMost = static_cast<double>((1 << kBits) - 1);
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double cell = (point[axis] - low[axis]) * scale;
        const double kept = cell > 0.0 ? std::min(cell, kMost) : 0.0;
        code = code << 1 | spread_bits(static_cast<std::uint64_t>(kept));
    }
    return code;
}

}  // namespace

std::vector<std::uint32_t> locality_order(std::span<const Point> positions)
{
    Point low = positions.empty() ? Point{} : positions.front();
    Point high = low;
    for (const Point& point : positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    }
    const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    const double scale = extent > 0.0 ? ((1 << kBits) - 1) / extent : 0.0;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> codes(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i)
    {
        codes[i] = {morton_code(positions[i], low, scale), i};
    }
    std::ranges::sort(codes);
    std::vector<std::uint32_t> order(positions.size());
    std::ranges::transform(codes, order.begin(), [](const auto& code) { return code.second; });
    return order;
}

std::vector<std::uint32_t> inverse_order(std::span<const std::uint32_t> order)
{
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
    {
        place[order[i]] = i;
    }
    return place;
}

std::vector<std::uint32_t> triangle_order(
    std::span<const Triangle> triangles, std::span<const std::uint32_t> order
)
{
    const std::vector<std::uint32_t> place = inverse_order(order);
    const auto smallest = [&](const Triangle& triangle) {
        return std::min({place[triangle[0]], place[triangle[1]], place[triangle[2]]});
    };
    std::vector<std::uint32_t> next(order.size() + 1, 0);
    for (const Triangle& triangle : triangles)
    {
        ++next[smallest(triangle) + 1];
    }
    for (std::size_t v = 1; v < next.size(); ++v)
    {
        next[v] += next[v - 1];
    }
    std::vector<std::uint32_t> result(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
    {
        result[next[smallest(triangles[t])]++] = t;
    }
    return result;
}

IndexedMesh in_order(const IndexedMesh& mesh, std::span<const std::uint32_t> order)
{
    const std::vector<std::uint32_t> place = inverse_order(order);
    IndexedMesh result;
    result.positions = in_order(std::span<const Point>(mesh.positions), order);
    result.triangles.reserve(mesh.triangles.size());
    for (const std::uint32_t t : triangle_order(mesh.triangles, order))
    {
        const auto& [a, b, c] = mesh.triangles[t];
        result.triangles.push_back({place[a], place[b], place[c]});
    }
    return result;
}

}  // namespace vsplit::precompute
