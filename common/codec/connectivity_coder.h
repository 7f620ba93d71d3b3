#pragma once

// Based on: Pajarola, Rossignac, "Compressed Progressive Meshes", 2000 (batches of splits coded by a
// traversal of the coarse mesh). Where a split happened and which wedge it opened are predicted from
// the coarse geometry: edges inside a wedge are unusually long, triangles become better and valences
// approach six. Encoder and decoder run this same code.

#include "codec/choose.h"
#include "codec/connectivity_model.h"
#include "codec/context_model.h"
#include "codec/float_log.h"
#include "codec/refinement_mesh.h"
#include "codec/traversal_view.h"
#include "codec/vector3.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Codes which faces of a level are opened by splits. `Coder` is BitEncoder or BitDecoder.
template <typename Coder>
class ConnectivityCoder : private TraversalView
{
public:
    /// Works on `mesh`, whose level was started, learning in `model`. `plan` is needed by the encoder
    /// and ignored by the decoder. All must outlive the object.
    ConnectivityCoder(
        RefinementMesh& mesh,
        ConnectivityModel& model,
        Coder& coder,
        const LearningRates& rates,
        const SplitPlan* plan
    )
        : TraversalView(mesh), model_(model), coder_(coder), rates_(rates), plan_(plan)
    {
    }

    /// Codes the next `count` splits, asking faces from `cursor` up to `end` (exclusive).
    /// Appends to `splits`; moves `cursor` past the last face asked.
    /// Result: false when the faces ended before `count` splits were found.
    [[nodiscard]] bool run(
        std::int32_t& cursor, std::int32_t end, std::uint32_t count, std::vector<Split>& splits
    )
    {
        for (; count > 0 && cursor < end; ++cursor)
        {
            prefetch(cursor, end);
            if (faces_[cursor].state != FaceState::Free)
            {
                continue;
            }
            const EdgeView view = view_of(faces_[cursor]);
            if (!ask_split(cursor, view))
            {
                faces_[cursor].state = FaceState::Refused;
                continue;
            }
            splits.push_back(code_wedge(cursor, view));
            --count;
        }
        return count == 0;
    }

private:
    [[gnu::always_inline]] bool ask_split(std::int32_t index, const EdgeView& view)
    {
        const Face& face = faces_[index];
        const auto [b0, b1, b2] = view.bucket;
        const std::int32_t larger = greater_of(b0, b1);
        const std::int32_t smaller = lesser_of(b0, b1);
        const std::int32_t second = greater_of(smaller, lesser_of(larger, b2));
        const std::int32_t v0 = lesser_of(15, valence(face.vertex[0]));
        const std::int32_t v1 = lesser_of(15, valence(face.vertex[1]));
        const std::int32_t v2 = lesser_of(15, valence(face.vertex[2]));
        const std::int32_t most = greater_of(v0, greater_of(v1, v2));
        const std::int32_t least = lesser_of(v0, lesser_of(v1, v2));
        // The longest edge, the first of equal ones, with the greater valence of its ends.
        const std::int32_t longest = greater_of(
            greater_of(b0 * 64 + 32 + greater_of(v1, v2), b1 * 64 + 16 + greater_of(v2, v0)),
            b2 * 64 + greater_of(v0, v1)
        );
        const std::int32_t best = longest >> 6;
        const std::int32_t ends = longest & 15;
        const std::int32_t longest_log =
            greater_of(face.edge_log[0], greater_of(face.edge_log[1], face.edge_log[2]));
        const std::array<std::int32_t*, 6> weights{
            at(model_.split_best_edge, view.free_neighbours * 32 + best),
            at(model_.split_second_edge, second),
            at(model_.split_edge_valence, ends * 12 + (best * 3 >> 3)),
            at(model_.split_shape,
               clamp_int(longest_log - ((view.own - longest_log) >> 1) + 4, 0, 31)),
            at(model_.split_valences, least * 16 + most),
            at(model_.split_size, clamp_int((view.own * 85 >> 8) - view.local_log + 16, 0, 31)),
        };
        const bool wanted =
            Coder::kEncodes &&
            plan_->split_of_face[static_cast<std::size_t>(index)] != SplitPlan::kNoSplit;
        return code_logistic(coder_, weights, wanted, rates_.split);
    }

    template <typename Table>
    static std::int32_t* at(Table& table, std::int32_t index)
    {
        return &table[static_cast<std::size_t>(index)];
    }

    Split code_wedge(std::int32_t seed, const EdgeView& view)
    {
        const Split* planned = nullptr;
        Split split;
        if constexpr (Coder::kEncodes)
        {
            planned = &plan_->splits[plan_->split_of_face[static_cast<std::size_t>(seed)]];
        }
        const Corner kept = code_kept(seed, view, planned);
        Wedge wedge{.first = kept, .last = kept, .length = 1, .kept = vertex(kept)};
        faces_[seed].state = FaceState::Taken;
        grow(wedge, view.local_log, seed, planned);
        split.first = wedge.first;
        split.wedge = static_cast<std::uint8_t>(wedge.length);
        split.before = static_cast<std::uint8_t>(wedge.before);
        split.kind = code_boundary(wedge, planned);
        update_valences(wedge, split.kind);
        return split;
    }

    using KeptWeights = std::array<std::int32_t*, 5>;

    /// Longest of the edges that come next round each corner of a face, see kept_weights().
    std::array<std::int32_t, 3> edges_beyond(const Face& face, const EdgeView& view) const
    {
        const auto left = [&](std::size_t k) {
            return free_edge_bucket(next_corner(face.opposite[k]), view.beyond[k]) &
                   mask_if(view.bucket[k] != 0);
        };
        const auto right = [&](std::size_t k) {
            return free_edge_bucket(previous_corner(face.opposite[k]), view.beyond[k]) &
                   mask_if(view.bucket[k] != 0);
        };
        return {
            greater_of(left(2), right(1)),
            greater_of(left(0), right(2)),
            greater_of(left(1), right(0))};
    }

    template <std::size_t k>
    [[gnu::always_inline]] KeptWeights kept_weights(
        const Face& face, const EdgeView& view, std::int32_t beyond
    )
    {
        constexpr std::size_t n = k == 2 ? 0 : k + 1;
        constexpr std::size_t p = k == 0 ? 2 : k - 1;
        const std::int32_t longer = greater_of(view.bucket[n], view.bucket[p]);
        const std::int32_t shorter = lesser_of(view.bucket[n], view.bucket[p]);
        const std::int32_t kept_valence = lesser_of(15, valence(face.vertex[k]));
        return {
            at(model_.kept_valence, kept_valence),
            at(model_.kept_longer_edge, longer + (shorter != 0 ? 32 : 0)),
            at(model_.kept_shorter_edge, shorter + (longer > 14 ? 32 : 0)),
            at(model_.kept_far_edge, clamp_int((3 * face.edge_log[k] - view.own) / 3 + 16, 0, 31)),
            at(model_.kept_beyond, (beyond >> 1) * 16 + kept_valence),
        };
    }

    /// Kept within a range in which no difference of two scores overflows.
    static std::int32_t kept_score(const KeptWeights& weights)
    {
        return clamp_int(weight_sum(weights) >> 8, -(1 << 20), 1 << 20);
    }

    [[gnu::always_inline]] Corner code_kept(
        std::int32_t seed, const EdgeView& view, const Split* planned
    )
    {
        const Face& face = faces_[seed];
        const auto beyond = edges_beyond(face, view);
        const KeptWeights weights0 = kept_weights<0>(face, view, beyond[0]);
        const KeptWeights weights1 = kept_weights<1>(face, view, beyond[1]);
        const KeptWeights weights2 = kept_weights<2>(face, view, beyond[2]);
        const std::int32_t score1 = kept_score(weights1);
        const std::int32_t score2 = kept_score(weights2);
        std::size_t wanted = 3;
        if constexpr (Coder::kEncodes)
        {
            const auto& vertices = faces_[seed].vertex;
            wanted = static_cast<std::size_t>(
                std::ranges::find(vertices, vertex(planned->first)) - vertices.begin()
            );
        }
        const std::uint32_t first = squash(kept_score(weights0) - log_sum(score1, score2));
        const std::uint32_t second = squash(score1 - score2);
        std::size_t kept = 0;
        if (!coder_.bit(first, wanted == 0))
        {
            kept = coder_.bit(second, wanted == 1) ? 1 : 2;
        }
        const std::uint32_t share = ((65536U - first) * second) >> 16;
        const auto learn = [&](const KeptWeights& weights, bool is, std::uint32_t probability) {
            const std::int32_t error = (is ? 65535 : 0) - static_cast<std::int32_t>(probability);
            add_to_weights(weights, (error * rates_.wedge) >> 15);
        };
        learn(weights0, kept == 0, first);
        learn(weights1, kept == 1, share);
        learn(weights2, kept == 2, 65536U - first - share);
        return seed * 4 + static_cast<Corner>(kept);
    }

    /// A wedge while it grows: corners at the kept vertex of its first and last face.
    struct Wedge
    {
        Corner first = -1;
        Corner last = -1;
        std::int32_t length = 1;
        std::int32_t before = 0;  ///< Faces to the right of the seed.
        std::uint32_t kept = 0;
        Vector3 sum{};  ///< Sum of the ring's other vertices, relative to the kept one.
    };

    Vector3 relative(std::uint32_t vertex, std::uint32_t origin) const
    {
        return to_vector(points_[vertex]) - to_vector(points_[origin]);
    }

    /// Asks, first towards the left end, then towards the right one, whether the wedge goes on.
    void grow(Wedge& wedge, std::int32_t local_log, std::int32_t seed, const Split* planned)
    {
        wedge.sum = relative(vertex(next_corner(wedge.first)), wedge.kept) +
                    relative(vertex(previous_corner(wedge.first)), wedge.kept);
        std::int32_t before = 0;
        std::int32_t after = 0;
        if constexpr (Coder::kEncodes)
        {
            Corner corner = planned->first;
            for (; face_of(corner) != seed; ++before)
            {
                corner = next_corner(opposite(next_corner(corner)));
            }
            after = planned->wedge - 1 - before;
        }
        grow_side<false>(wedge, local_log, after);
        grow_side<true>(wedge, local_log, before);
    }

    template <bool kRight>
    void grow_side(Wedge& wedge, std::int32_t local_log, std::int32_t wanted)
    {
        const std::int32_t valence_limit = valence(wedge.kept) - 1;
        std::int32_t grown = 0;
        while (wedge.length < kMaxWedge && wedge.length < valence_limit)
        {
            const Corner end = kRight ? wedge.first : wedge.last;
            const Corner crossing = kRight ? previous_corner(end) : next_corner(end);
            const Corner across = opposite(crossing);
            if (!is_free(across))
            {
                return;
            }
            const Vector3 grown_sum = wedge.sum + relative(vertex(across), wedge.kept);
            const auto weights =
                grow_weights<kRight>(wedge, crossing, local_log, grown > 0, grown_sum);
            if (!code_logistic(coder_, weights, grown < wanted, rates_.wedge))
            {
                return;
            }
            ++grown;
            ++wedge.length;
            wedge.before += kRight ? 1 : 0;
            wedge.sum = grown_sum;
            faces_[face_of(across)].state = FaceState::Taken;
            (kRight ? wedge.first : wedge.last) =
                kRight ? previous_corner(across) : next_corner(across);
        }
    }

    template <bool kRight>
    std::array<std::int32_t*, 7> grow_weights(
        const Wedge& wedge,
        Corner crossing,
        std::int32_t local_log,
        bool again,
        const Vector3& grown_sum
    )
    {
        const Corner end = kRight ? wedge.first : wedge.last;
        const Corner across = opposite(crossing);
        const Corner entered = kRight ? previous_corner(across) : next_corner(across);
        const Corner far = kRight ? previous_corner(entered) : next_corner(entered);
        const Corner beyond = opposite(far);
        const std::int32_t next_edge = beyond < 0         ? 30
                                       : !is_free(beyond) ? 31
                                                          : ratio_bucket(edge_ratio(far)) + 1;
        const std::uint32_t cut = kRight ? vertex(next_corner(end)) : vertex(previous_corner(end));
        const std::int32_t length = wedge.length - 1;
        const std::int32_t longer = length > 0 ? 1 : 0;
        const std::int32_t kept_valence = std::min(15, valence(wedge.kept) - wedge.length + 2);
        // Is the vertex to be taken in nearer the polygon's centre than the kept one?
        const Vector3 centre = grown_sum * (1.0F / static_cast<float>(wedge.length + 3));
        const Vector3 reach = relative(vertex(across), wedge.kept) - centre;
        const std::int32_t nearness = clamp_int(
            steps_log2<3>(dot(reach, reach) + 1.0F) - steps_log2<3>(dot(centre, centre) + 1.0F) +
                32,
            0,
            63
        );
        const std::int32_t edge_log =
            faces_[face_of(crossing)].edge_log[static_cast<std::size_t>(crossing & 3)];
        return {
            at(model_.grow_start, ((kRight ? 2 : 0) + (again ? 1 : 0)) * 8 + length),
            at(model_.grow_edge, ratio_bucket(edge_ratio(crossing)) + 32 * std::min(length, 2)),
            at(model_.grow_cut_valence, std::min(15, valence(cut)) + 16 * longer),
            at(model_.grow_kept_valence, kept_valence * 8 + length),
            at(model_.grow_beyond, next_edge),
            at(model_.grow_length,
               clamp_int((edge_log - local_log + 24) >> 1, 0, 31) + 32 * longer),
            at(model_.grow_centre, nearness * 8 + length),
        };
    }

    SplitKind code_boundary(const Wedge& wedge, const Split* planned)
    {
        const bool right = opposite(previous_corner(wedge.first)) < 0;
        const bool left = opposite(next_corner(wedge.last)) < 0;
        if (!right && !left)
        {
            return SplitKind::Interior;
        }
        SplitKind wanted = SplitKind::Interior;
        if constexpr (Coder::kEncodes)
        {
            wanted = planned->kind;
        }
        const std::size_t context = (right ? 2U : 0U) + (left ? 1U : 0U) +
                                    4U * static_cast<std::size_t>(std::min(wedge.length - 1, 2));
        const std::array<std::int32_t*, 1> touches{&model_.boundary[context]};
        if (!code_logistic(coder_, touches, wanted != SplitKind::Interior, rates_.wedge))
        {
            return SplitKind::Interior;
        }
        if (!right || !left)
        {
            return left ? SplitKind::BoundaryLeft : SplitKind::BoundaryRight;
        }
        const std::array<std::int32_t*, 1> side{&model_.boundary[12]};
        return code_logistic(coder_, side, wanted == SplitKind::BoundaryRight, rates_.wedge)
                   ? SplitKind::BoundaryRight
                   : SplitKind::BoundaryLeft;
    }

    void change_valence(std::uint32_t vertex, std::int32_t difference)
    {
        std::uint16_t& valence = valences_[vertex];
        if (valence != kManyNeighbours)
        {
            valence =
                static_cast<std::uint16_t>(clamp_int(valence + difference, 0, kManyNeighbours));
        }
    }

    /// Brings the valences up to date at once, so that later questions of the level see them.
    void update_valences(const Wedge& wedge, SplitKind kind)
    {
        if (kind != SplitKind::BoundaryRight)
        {
            change_valence(vertex(next_corner(wedge.first)), 1);
        }
        if (kind != SplitKind::BoundaryLeft)
        {
            change_valence(vertex(previous_corner(wedge.last)), 1);
        }
        const std::int32_t opened = kind == SplitKind::Interior ? 2 : 1;
        change_valence(wedge.kept, opened - wedge.length);
    }

    ConnectivityModel& model_;
    Coder& coder_;
    LearningRates rates_;
    const SplitPlan* plan_;
};

}  // namespace vsplit::codec
