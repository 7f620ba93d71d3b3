#pragma once

#include "codec/context_model.h"

#include <array>
#include <cstdint>

namespace vsplit::codec {

/// Learned statistics of the growth of the complete mesh; see proto/STREAM_FORMAT.md, "Growth".
struct GrowthModel
{
    static constexpr std::size_t kCounts = 16;
    static constexpr std::size_t kHistories = 256;
    /// Weights by two counts.
    using CountPair = std::array<std::int32_t, kCounts * kCounts>;

    // How the mesh goes on beyond an edge; contexts are faces so far at border vertices.
    CountPair previous_ends{};    ///< the edge's beginning x the one before it
    CountPair previous_across{};  ///< the edge's beginning x its end
    CountPair next_ends{};        ///< the edge's end x the one behind it
    CountPair next_across{};      ///< the edge's end x its beginning
    std::array<std::int32_t, kHistories * kCounts> previous_history{};  ///< last steps x beginning
    std::array<std::int32_t, kHistories * kCounts> next_history{};      ///< last steps x end
    std::array<AdaptiveBit, 4> rare{};   ///< boundary or touch; by which neighbours are closed
    std::array<AdaptiveBit, 4> touch{};  ///< touch rather than boundary
    AdaptiveBit near{};                  ///< the place touched is near on the loop

    // Whether a vertex is one of the coarse mesh; contexts are distances to what it could be.
    std::array<std::int32_t, 32> coarse_nearest{};
    std::array<std::int32_t, 32 * 16> coarse_residual{};  ///< x size of residuals near by
    std::array<std::int32_t, 32 * 32> coarse_second{};    ///< x distance of the second
    std::array<AdaptiveBit, 8> candidate{};               ///< is it the i-th nearest?

    /// Low bits of a coarse vertex: by bits below and by where in the cell it is expected.
    std::array<std::array<AdaptiveBit, 16>, 4> low{};
    std::array<AdaptiveBit, 8>
        moved{};  ///< Was it shown in another cell? By bits that are missing.
    std::array<AdaptiveBit, 2> below{};    ///< On which side; by that on which it is expected.
    std::array<IntegerModel, 8> beyond{};  ///< How far from the cell.

    /// Which parallelogram predicts: by how many there are, size of residuals near by, and how far
    /// they differ.
    std::array<std::array<std::array<std::array<AdaptiveBit, 4>, 16>, 4>, 3> choice{};

    /// Residuals on the three axes by kind of prediction and size of residuals near by.
    std::array<std::array<IntegerModel, 16>, 4> first{};
    std::array<std::array<IntegerModel, 16>, 4> second{};
    std::array<std::array<IntegerModel, 16>, 4> last{};
};

}  // namespace vsplit::codec
