#pragma once

// Based on: Pajarola, Rossignac, "Compressed Progressive Meshes", 2000 (batches of splits coded by a
// traversal of the coarse mesh). Where a split happened and which wedge it opened are predicted from
// the coarse geometry: edges inside a wedge are unusually long, triangles become better and valences
// approach six. Encoder and decoder run this same code.

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
            const EdgeView view = view_of(cursor);
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
    bool ask_split(std::int32_t index, const EdgeView& view)
    {
        const Face& face = faces_[index];
        const auto& bucket = view.bucket;
        const std::int32_t larger = std::max(bucket[0], bucket[1]);
        const std::int32_t smaller = std::min(bucket[0], bucket[1]);
        const std::int32_t best = std::max(larger, bucket[2]);
        const std::int32_t second = std::max(smaller, std::min(larger, bucket[2]));
        const int longest = bucket[2] > larger ? 2 : bucket[1] > bucket[0] ? 1 : 0;
        const std::array<std::int32_t, 3> v{
            valence(face.vertex[0]), valence(face.vertex[1]), valence(face.vertex[2])};
        const std::int32_t most = std::min(15, std::max(v[0], std::max(v[1], v[2])));
        const std::int32_t least = std::min(15, std::min(v[0], std::min(v[1], v[2])));
        const std::int32_t ends = std::min(
            15, std::max(v[longest == 2 ? 0 : longest + 1], v[longest == 0 ? 2 : longest - 1])
        );
        const std::int32_t own = log_total(face);
        const std::int32_t longest_log =
            std::max(face.edge_log[0], std::max(face.edge_log[1], face.edge_log[2]));
        const std::array<std::int32_t*, 6> weights{
            &model_.split_best_edge[static_cast<std::size_t>(view.free_neighbours * 32 + best)],
            &model_.split_second_edge[static_cast<std::size_t>(second)],
            &model_.split_edge_valence[static_cast<std::size_t>(ends * 12 + (best * 3 >> 3))],
            &model_.split_shape[static_cast<std::size_t>(
                clamp_int(longest_log - ((own - longest_log) >> 1) + 4, 0, 31)
            )],
            &model_.split_valences[static_cast<std::size_t>(least * 16 + most)],
            &model_.split_size[static_cast<std::size_t>(
                clamp_int((own * 85 >> 8) - view.local_log + 16, 0, 31)
            )],
        };
        const bool wanted =
            Coder::kEncodes &&
            plan_->split_of_face[static_cast<std::size_t>(index)] != SplitPlan::kNoSplit;
        return code_logistic(coder_, weights, wanted, rates_.split);
    }

    Split code_wedge(std::int32_t seed, const EdgeView& view)
    {
        const Split* planned = nullptr;
        Split split;
        split.seed = seed;
        if constexpr (Coder::kEncodes)
        {
            split.source = plan_->split_of_face[static_cast<std::size_t>(seed)];
            planned = &plan_->splits[split.source];
        }
        const Corner kept = code_kept(seed, view, planned);
        Wedge wedge{.first = kept, .last = kept, .length = 1, .kept = vertex(kept)};
        faces_[seed].state = FaceState::Taken;
        grow(wedge, view.local_log, seed, planned);
        split.first = wedge.first;
        split.wedge = static_cast<std::uint8_t>(wedge.length);
        split.kind = code_boundary(wedge, planned);
        update_valences(wedge, split.kind);
        return split;
    }

    using KeptWeights = std::array<std::int32_t*, 5>;

    KeptWeights kept_weights(std::int32_t seed, const EdgeView& view, std::size_t k)
    {
        const Face& face = faces_[seed];
        const std::size_t n = k == 2 ? 0 : k + 1;
        const std::size_t p = k == 0 ? 2 : k - 1;
        const std::int32_t longer = std::max(view.bucket[n], view.bucket[p]);
        const std::int32_t shorter = std::min(view.bucket[n], view.bucket[p]);
        const std::int32_t kept_valence = std::min(15, valence(face.vertex[k]));
        std::int32_t beyond = 0;
        if (view.bucket[p] != 0)
        {
            beyond = free_edge_bucket(previous_corner(previous_corner(face.opposite[p])), 0);
        }
        if (view.bucket[n] != 0)
        {
            beyond =
                std::max(beyond, free_edge_bucket(next_corner(next_corner(face.opposite[n])), 0));
        }
        return {
            &model_.kept_valence[static_cast<std::size_t>(kept_valence)],
            &model_.kept_longer_edge[static_cast<std::size_t>(longer + (shorter != 0 ? 32 : 0))],
            &model_.kept_shorter_edge[static_cast<std::size_t>(shorter + (longer > 14 ? 32 : 0))],
            &model_.kept_far_edge[static_cast<std::size_t>(
                clamp_int((3 * face.edge_log[k] - log_total(face)) / 3 + 16, 0, 31)
            )],
            &model_.kept_beyond[static_cast<std::size_t>((beyond >> 1) * 16 + kept_valence)],
        };
    }

    Corner code_kept(std::int32_t seed, const EdgeView& view, const Split* planned)
    {
        std::array<KeptWeights, 3> weights;
        std::array<std::int32_t, 3> score{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            weights[k] = kept_weights(seed, view, k);
            std::int32_t total = 0;
            for (const std::int32_t* weight : weights[k])
            {
                total = wrapping_add(total, *weight);
            }
            // Kept within a range in which no difference of two scores overflows.
            score[k] = clamp_int(total >> 8, -(1 << 20), 1 << 20);
        }
        std::size_t wanted = 3;
        if constexpr (Coder::kEncodes)
        {
            const auto& vertices = faces_[seed].vertex;
            wanted = static_cast<std::size_t>(
                std::ranges::find(vertices, vertex(planned->first)) - vertices.begin()
            );
        }
        const std::uint32_t first = squash(score[0] - log_sum(score[1], score[2]));
        const std::uint32_t second = squash(score[1] - score[2]);
        std::size_t kept = 0;
        if (!coder_.bit(first, wanted == 0))
        {
            kept = coder_.bit(second, wanted == 1) ? 1 : 2;
        }
        const std::uint32_t share = ((65536U - first) * second) >> 16;
        const std::array<std::uint32_t, 3> probability{first, share, 65536U - first - share};
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::int32_t error =
                (k == kept ? 65535 : 0) - static_cast<std::int32_t>(probability[k]);
            const std::int32_t step = (error * rates_.wedge) >> 15;
            for (std::int32_t* weight : weights[k])
            {
                *weight = wrapping_add(*weight, step);
            }
        }
        return seed * 4 + static_cast<Corner>(kept);
    }

    /// A wedge while it grows: corners at the kept vertex of its first and last face.
    struct Wedge
    {
        Corner first = -1;
        Corner last = -1;
        std::int32_t length = 1;
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
        const auto at = [](auto& table, std::int32_t index) {
            return &table[static_cast<std::size_t>(index)];
        };
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
