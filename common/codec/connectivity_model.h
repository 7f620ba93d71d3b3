#pragma once

#include "codec/refinement_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::codec {

/// Learned weights of the connectivity decisions; each table is indexed by one context, see
/// proto/STREAM_FORMAT.md, "Connectivity". Kept over the whole stream. Zero to begin with.
struct ConnectivityModel
{
    // Does a split cover this face?
    std::array<std::int32_t, 4 * 32> split_best_edge{};      ///< free neighbours x longest edge
    std::array<std::int32_t, 32> split_second_edge{};        ///< second longest edge
    std::array<std::int32_t, 16 * 12> split_edge_valence{};  ///< its end's valence x longest edge
    std::array<std::int32_t, 32> split_shape{};              ///< longest edge against the others
    std::array<std::int32_t, 16 * 16> split_valences{};      ///< least x greatest valence
    std::array<std::int32_t, 32> split_size{};               ///< size against the neighbours'
    // Which corner is the kept vertex?
    std::array<std::int32_t, 16> kept_valence{};
    std::array<std::int32_t, 64> kept_longer_edge{};  ///< longer edge at the corner x other free
    std::array<std::int32_t, 64>
        kept_shorter_edge{};                       ///< shorter edge at the corner x longer one long
    std::array<std::int32_t, 32> kept_far_edge{};  ///< opposite edge against the mean
    std::array<std::int32_t, 16 * 16> kept_beyond{};  ///< best next edge round the corner x valence
    // Does the wedge go on?
    std::array<std::int32_t, 64> grow_start{};        ///< side, first question, length
    std::array<std::int32_t, 32 * 4> grow_edge{};     ///< the edge that would be inside x length
    std::array<std::int32_t, 32> grow_cut_valence{};  ///< valence of that edge's far end x longer
    std::array<std::int32_t, 16 * 8> grow_kept_valence{};  ///< valence that would stay x length
    std::array<std::int32_t, 40> grow_beyond{};            ///< the next edge round the kept vertex
    std::array<std::int32_t, 64> grow_length{};            ///< edge against the local mean x longer
    std::array<std::int32_t, 64 * 8> grow_centre{};  ///< which vertex is nearer the centre x length
    // Does the wedge touch the boundary?
    std::array<std::int32_t, 16> boundary{};
};

/// Learning rates, 1/32768, of one batch: high while little was seen, then falling.
struct LearningRates
{
    std::int32_t split = 650;
    std::int32_t wedge = 1100;

    /// The rates of the `batch`-th batch, batch >= 1.
    [[nodiscard]] static LearningRates of_batch(std::uint32_t batch)
    {
        const auto number = static_cast<std::int32_t>(std::min<std::uint32_t>(batch, 10000));
        return {std::max(650, 4000 / number), std::max(1100, 7000 / number)};
    }
};

/// What the encoder wants coded: the splits of a level, and for each face of the coarse mesh the split
/// whose wedge holds it, or kNoSplit.
struct SplitPlan
{
    static constexpr std::uint32_t kNoSplit = 0xFFFFFFFF;
    std::vector<Split> splits;
    std::vector<std::uint32_t> split_of_face;
};

}  // namespace vsplit::codec
