#pragma once

#include "codec/context_model.h"
#include "core/result.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Sorts vertices so that those at one position stand together, lower indices first.
/// `position`: returns the grid position of a vertex. Cost: n log n.
[[nodiscard]] inline std::vector<std::uint32_t> group_by_position(
    std::uint32_t vertex_count,
    const std::function<std::array<std::int32_t, 3>(std::uint32_t)>& position
)
{
    std::vector<std::uint32_t> order(vertex_count);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const auto left = position(a);
        const auto right = position(b);
        return left != right ? left < right : a < b;
    });
    return order;
}

/// Codes one group of vertices at one position: whether all are one vertex of the source mesh, else
/// for each which earlier one it is, if any. `stitches`: by vertex the smallest vertex it is one with;
/// read by the encoder, written by the decoder.
template <typename Coder>
void code_stitch_group(
    Coder& coder,
    AdaptiveBit& all_one,
    std::span<const std::uint32_t> group,
    std::span<std::uint32_t> stitches
)
{
    const auto joined = [&](std::uint32_t v) { return stitches[v] == group.front(); };
    if (code_bit(coder, all_one, Coder::kEncodes && std::ranges::all_of(group, joined)))
    {
        for (const std::uint32_t v : group)
        {
            stitches[v] = group.front();
        }
        return;
    }
    std::vector<std::uint32_t> representatives;
    representatives.reserve(group.size());
    representatives.push_back(group.front());
    stitches[group.front()] = group.front();
    for (const std::uint32_t v : group.subspan(1))
    {
        std::size_t wanted = 0;
        if constexpr (Coder::kEncodes)
        {
            const auto found = std::ranges::find(representatives, stitches[v]);
            wanted = static_cast<std::size_t>(found - representatives.begin());
        }
        const int bits = static_cast<int>(std::bit_width(representatives.size()));
        const std::size_t choice = coder.raw(static_cast<std::uint32_t>(wanted), bits);
        if (choice < representatives.size())
        {
            stitches[v] = representatives[choice];
        }
        else
        {
            representatives.push_back(v);
            stitches[v] = v;
        }
    }
}

/// Codes which vertices of the complete mesh are one vertex in the source mesh.
/// `position`: grid position by vertex; `stitches`: one entry a vertex, see code_stitch_group().
/// Source: proto/STREAM_FORMAT.md, "Stitch chunk". Safe on untrusted input.
template <typename Coder>
void code_stitches(
    Coder& coder,
    const std::function<std::array<std::int32_t, 3>(std::uint32_t)>& position,
    std::span<std::uint32_t> stitches
)
{
    const auto order = group_by_position(static_cast<std::uint32_t>(stitches.size()), position);
    AdaptiveBit all_one;
    for (std::size_t begin = 0; begin < order.size();)
    {
        std::size_t end = begin + 1;
        while (end < order.size() && position(order[end]) == position(order[begin]))
        {
            ++end;
        }
        if (end - begin > 1)
        {
            code_stitch_group(
                coder, all_one, std::span(order).subspan(begin, end - begin), stitches
            );
        }
        else
        {
            stitches[order[begin]] = order[begin];
        }
        begin = end;
    }
}

}  // namespace vsplit::codec
