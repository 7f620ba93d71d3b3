#pragma once

#include "codec/stream_encoder.h"
#include "precompute/collapse_cost.h"
#include "precompute/collapse_mesh.h"
#include "precompute/cut_copies.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace vsplit::precompute {

/// How the collapses of one level are chosen.
struct LevelStyle
{
    double cost_weight = 1.0;  ///< Of log(1 + price / median price) in the order.
    double shape = 0.0;     ///< Of how bad the worst new triangle is: regular meshes code better.
    double centring = 0.0;  ///< Of how far the removed vertex is from its ring's mean.
    double apex = 0.0;      ///< Of how far the kept vertex is from the ring's mean.
    double packing = 0.0;   ///< Bonus for stars beside stars already taken: larger batches.
    double cheapest_share = 1.0;  ///< Only this share of the vertices, the cheapest, may go.
    double largest_share = 0.18;  ///< At most this share of the vertices goes in the level.
};

/// Collapses that end a level's list in the order of their cost.
inline constexpr std::size_t kCostliest = 512;

/// Describes a collapse as the codec wants it. Precondition: CollapseMesh::can_collapse().
[[nodiscard]] codec::Collapse describe_collapse(
    std::uint32_t removed, const OneRing& ring, std::size_t kept
);

/// Makes one level after another, finest first, out of independent half-edge collapses.
class LevelBuilder
{
public:
    /// `positions`: V points in grid units; `locked`: V flags, vertices never removed, or empty.
    /// `threads`: at least 1; the levels do not depend on it. `mesh` and `cost` must outlive the builder.
    LevelBuilder(
        CollapseMesh& mesh,
        CollapseCost& cost,
        std::span<const Vector3> positions,
        std::span<const std::uint8_t> locked,
        unsigned threads = 1
    );

    /// From now on the copies of a cut vertex go together into those of another one, or not at all, so
    /// that no level opens the cut. `stitches`: as RepairedMesh's, or empty; must outlive the builder.
    void fold_together(std::span<const std::uint32_t> stitches) { copies_ = CutCopies(stitches); }

    /// Chooses and carries out the collapses of the next coarser level. `most`: at most so many.
    /// Result: the collapses, the costliest ones (at most kCostliest) last, cheapest first, the others
    /// before them in the order of their vertices; empty when nothing can go.
    /// Source: Pajarola, Rossignac, "Compressed Progressive Meshes", 2000, section 4 (independence);
    /// here stars are disjoint but rings may share vertices.
    [[nodiscard]] std::vector<codec::Collapse> next_level(
        const LevelStyle& style, std::size_t most
    );

    /// What the collapses of the last next_level() took away, in its order; empty without wedges.
    [[nodiscard]] std::vector<codec::SeamRecord> take_seams() { return std::move(seams_); }

    /// Takes note that components were taken out of the mesh.
    void forget_removed();

    /// Vertices left.
    [[nodiscard]] std::size_t vertex_count() const { return alive_.size(); }

private:
    static constexpr float kSettled = std::numeric_limits<float>::infinity();

    /// Neighbours that a removed vertex may have.
    static constexpr std::uint32_t kMostNeighbours = codec::kMaxWedge + 2;

    /// Neighbours that a kept vertex may come to have.
    static constexpr std::uint32_t kValenceLimit = 12;

    /// What folding into one neighbour costs; infinite when that is not geometrically sound.
    struct Candidate
    {
        float price = std::numeric_limits<float>::infinity();
        float key = std::numeric_limits<float>::infinity();
    };

    /// Of the level's cheapest candidates, one a vertex.
    struct Prices
    {
        double median = 1.0;
        float most = std::numeric_limits<float>::infinity();  ///< Dearer ones may not go.
    };

    [[nodiscard]] bool may_go(std::uint32_t vertex) const;
    [[nodiscard]] std::span<Candidate> candidates_of(std::uint32_t vertex);
    [[nodiscard]] Prices typical_prices(const LevelStyle& style);
    void collect(const LevelStyle& style);
    void collect_vertex(std::uint32_t vertex, const LevelStyle& style);
    void collect_copies(std::uint32_t first, const LevelStyle& style);
    void rate(
        std::uint32_t vertex,
        const OneRing& ring,
        const LevelStyle& style,
        std::span<Candidate> candidates
    ) const;
    void rank(const LevelStyle& style);
    bool try_vertex(
        std::uint32_t vertex, const LevelStyle& style, std::vector<codec::Collapse>& done
    );
    bool try_copies(
        std::uint32_t first, const LevelStyle& style, std::vector<codec::Collapse>& done
    );
    void carry_out(
        std::uint32_t vertex,
        const OneRing& ring,
        std::size_t kept,
        const LevelStyle& style,
        std::vector<codec::Collapse>& done
    );
    void put_in_order(std::vector<codec::Collapse>& done);
    void reward_neighbours(const OneRing& ring, const LevelStyle& style);

    CollapseMesh& mesh_;
    CollapseCost& cost_;
    std::span<const Vector3> positions_;
    std::span<const std::uint8_t> locked_;
    unsigned threads_;
    CutCopies copies_;
    std::size_t limit_ = 0;  ///< Collapses that the level may have.
    std::vector<std::uint32_t> alive_;
    std::vector<Candidate> candidates_;  ///< By vertex that may go, one for each of its neighbours.
    std::vector<std::uint32_t> first_;   ///< By vertex its first candidate.
    /// By vertex the least key, copies that of the first of them; infinite when it is removed, shares a face with a removed one's star,
    /// or cannot go.
    std::vector<float> best_key_;
    std::vector<std::pair<float, std::uint32_t>> heap_;
    std::vector<codec::SeamRecord> seams_;  ///< By collapse of the last level.
};

}  // namespace vsplit::precompute
