#pragma once

#include "codec/ring_frames.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace vsplit::codec {

/// A removed vertex's frame and the position that is to be predicted in it.
struct FitSample
{
    RingFrame frame;
    std::array<std::int32_t, 3> position{};
};

/// Finds better prediction weights for a chunk by least squares, reweighted twice so that it is the
/// bits, not the squares, that get fewer.
/// `samples`: the chunk's interior splits; `current`: the weights in force.
/// Result: weights whose estimated saving exceeds their cost, or nothing.
/// Source: Daubechies, DeVore, Fornasier, Gunturk, "Iteratively Reweighted Least Squares", 2010.
[[nodiscard]] std::optional<PredictionWeights> fit_weights(
    std::span<const FitSample> samples, const PredictionWeights& current
);

}  // namespace vsplit::codec
