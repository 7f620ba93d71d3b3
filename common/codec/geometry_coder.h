#pragma once

// Based on: Touma, Gotsman, "Triangle Mesh Compression", 1998 (residuals of a prediction); the axis along
// which the surface is steepest is coded last, given the other two.

#include "codec/choose.h"
#include "codec/context_model.h"
#include "codec/float_log.h"
#include "codec/ring_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

/// Learned statistics of position residuals. Kept over the whole stream.
struct GeometryModel
{
    /// By boundary and ring radius in half octaves; for the first two axes.
    std::array<std::array<IntegerModel, 32>, 2> tangential{};
    /// By the expected normal displacement in half octaves; for the last axis.
    std::array<IntegerModel, 48> normal{};
};

/// Rounds half up. Precondition: |value| < 2^30.
[[nodiscard]] inline std::int32_t round_half_up(float value)
{
    const float shifted = value + 0.5F;
    const auto whole = static_cast<std::int32_t>(shifted);
    return whole - (static_cast<float>(whole) > shifted ? 1 : 0);
}

/// Codes one coordinate against its expected value; returns the coordinate.
template <typename Coder>
inline std::int32_t code_coordinate(
    Coder& coder, IntegerModel& model, float expected, std::int32_t actual
)
{
    const std::int32_t rounded = round_half_up(expected);
    const float rest = expected - static_cast<float>(rounded);
    const std::size_t sign_context = std::size_t{1} + (rest > 0.17F) - (rest < -0.17F);
    return rounded + code_integer(coder, model, actual - rounded, sign_context);
}

/// Codes the position of one removed vertex. `Coder` is BitEncoder or BitDecoder.
/// `actual`: the position, used by the encoder only. Result: the position in grid units; the caller
/// checks that it lies within the grid.
template <typename Coder>
[[nodiscard]] inline std::array<std::int32_t, 3> code_position(
    Coder& coder,
    GeometryModel& model,
    const Prediction& prediction,
    bool boundary,
    const std::array<std::int32_t, 3>& actual
)
{
    const auto& [expected, normal, height, radius] = prediction;
    const std::array<float, 3> slope{
        std::fabs(normal[0]), std::fabs(normal[1]), std::fabs(normal[2])};
    const std::int32_t steepest =
        choose(slope[0] >= std::max(slope[1], slope[2]), 0, choose(slope[1] >= slope[2], 1, 2));
    const auto last = static_cast<std::size_t>(steepest);
    const auto first = static_cast<std::size_t>((steepest + 1) & mask_if(steepest != 2));
    const std::size_t second = 3 - first - last;
    auto& tangential =
        model.tangential[boundary ? 1 : 0]
                        [static_cast<std::size_t>(clamp_int(steps_log2<1>(radius + 1.0F), 0, 31))];
    auto& along = model.normal[static_cast<std::size_t>(
        clamp_int(steps_log2<1>(std::fabs(height) * 0.5F + 0.02F * radius + 0.3F) + 5, 0, 47)
    )];
    std::array<std::int32_t, 3> position{};
    position[first] = code_coordinate(coder, tangential, expected[first], actual[first]);
    position[second] = code_coordinate(coder, tangential, expected[second], actual[second]);
    // The point stays near the plane through the prediction: solve for the steepest axis.
    const float off_first = static_cast<float>(position[first]) - expected[first];
    const float off_second = static_cast<float>(position[second]) - expected[second];
    const float on_plane =
        expected[last] - (normal[first] * off_first + normal[second] * off_second) / normal[last];
    position[last] = code_coordinate(coder, along, on_plane, actual[last]);
    return position;
}

}  // namespace vsplit::codec
