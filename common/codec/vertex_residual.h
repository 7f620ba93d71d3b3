#pragma once

#include "codec/coarse_surface.h"
#include "codec/geometry_coder.h"
#include "codec/growth_model.h"
#include "codec/vertex_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace vsplit::codec {

/// The axis along which a surface of that normal is steepest.
[[nodiscard]] inline std::size_t steepest_axis(const std::array<float, 3>& normal)
{
    const float x = std::fabs(normal[0]);
    const float y = std::fabs(normal[1]);
    const float z = std::fabs(normal[2]);
    return x >= y && x >= z ? 0U : y >= z ? 1U : 2U;
}

/// Codes a position against its expected one: two axes first, the steepest last, given the other two
/// and the plane of the coarse face below, `ground`. `surface_share`: how far the plane counts, 0 .. 1; `sizes`:
/// those of the residuals afterwards; `wanted`: encoder only.
template <typename Coder>
[[nodiscard]] std::array<std::int32_t, 3> code_residual(
    Coder& coder,
    GrowthModel& model,
    const CoarseSurface::Ground& ground,
    float surface_share,
    const Surroundings& seen,
    GuessKind kind,
    const Vector3& expected,
    const std::array<std::int32_t, 3>& wanted,
    ResidualSizes& sizes
)
{
    const Vector3& area = ground.area;
    const std::array<float, 3> guess{expected.x, expected.y, expected.z};
    const std::array<float, 3> normal{area.x, area.y, area.z};
    const std::size_t last = steepest_axis(normal);
    const std::size_t first = last == 2 ? 0 : last + 1;
    const std::size_t second = last == 0 ? 2 : last - 1;
    const auto row = static_cast<std::size_t>(kind);
    const auto bounded = [](std::uint32_t size) { return std::min<std::size_t>(size, 15); };
    std::array<std::int32_t, 3> position{};
    position[first] = code_coordinate(
        coder, model.first[row][bounded(seen.tangential)], guess[first], wanted[first]
    );
    const float off_first = static_cast<float>(position[first]) - guess[first];
    const std::uint32_t near_second = (seen.tangential + residual_size(off_first) + 1) / 2;
    position[second] = code_coordinate(
        coder, model.second[row][bounded(near_second)], guess[second], wanted[second]
    );
    const float off_second = static_cast<float>(position[second]) - guess[second];
    const float off_both = std::fabs(off_first) + std::fabs(off_second);
    float expected_last = guess[last];
    if (normal[last] != 0.0F)
    {
        const Vector3 to_plane = ground.corner[0] - expected;
        const float height = dot(to_plane, area) * surface_share;
        const float slope = normal[first] * off_first + normal[second] * off_second;
        expected_last += (height - slope) / normal[last];
    }
    const std::uint32_t near_last = (2 * seen.normal + residual_size(0.5F * off_both) + 1) / 3;
    position[last] =
        code_coordinate(coder, model.last[row][bounded(near_last)], expected_last, wanted[last]);
    sizes.tangential = ResidualSizes::blend(seen.tangential, off_both);
    sizes.normal =
        ResidualSizes::blend(seen.normal, static_cast<float>(position[last]) - expected_last);
    return position;
}

/// Codes one coordinate of a coarse vertex inside its cell, highest bit first, by where in what is left
/// of the cell it is expected. `corner`: least coordinate of the cell. Result: the coordinate.
template <typename Coder>
[[nodiscard]] std::int32_t code_in_cell(
    Coder& coder,
    GrowthModel& model,
    int bits,
    float expected,
    std::int32_t wanted,
    std::int32_t corner
)
{
    const std::int32_t offset = wanted - corner;
    for (int bit = bits - 1; bit >= 0; --bit)
    {
        const auto half = static_cast<float>(1 << bit);
        const float middle = static_cast<float>(corner) + half - 0.5F;
        const float off = (expected - middle) * (4.0F / half);
        const float kept = off < -8.0F ? -8.0F : off > 7.0F ? 7.0F : off;
        auto& models = model.low[static_cast<std::size_t>(std::min(bit, 3))];
        const auto where = static_cast<std::size_t>(kept + 8.0F);
        corner += code_bit(coder, models[where], ((offset >> bit) & 1) != 0) ? 1 << bit : 0;
    }
    return corner;
}

/// Completes the position of a coarse vertex that was shown in a cell of 2^`bits` positions an axis, or
/// in another one near by. `position`: the cell's least position, the vertex's afterwards; `wanted`:
/// encoder only. The caller checks that it lies within the grid.
template <typename Coder>
void code_coarse_position(
    Coder& coder,
    GrowthModel& model,
    int bits,
    const Vector3& expected,
    const std::array<std::int32_t, 3>& wanted,
    std::array<std::int32_t, 3>& position
)
{
    if (bits == 0)
    {
        return;
    }
    const std::array<float, 3> guess{expected.x, expected.y, expected.z};
    const std::int32_t cells = 1 << bits;
    auto& moved = model.moved[static_cast<std::size_t>(std::min(bits, 7))];
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::int32_t corner = position[axis];
        const std::int32_t offset = wanted[axis] - corner;
        if (!code_bit(coder, moved, offset < 0 || offset >= cells))
        {
            position[axis] = code_in_cell(coder, model, bits, guess[axis], wanted[axis], corner);
            continue;
        }
        const bool below = code_bit(
            coder, model.below[guess[axis] < static_cast<float>(corner) ? 1 : 0], offset < 0
        );
        const std::int32_t beyond = below ? -1 - offset : offset - cells;
        const std::int32_t distance = code_integer(
            coder, model.beyond[static_cast<std::size_t>(std::min(bits, 7))], beyond, 1
        );
        position[axis] = below ? corner - 1 - distance : corner + cells + distance;
    }
}

}  // namespace vsplit::codec
