#pragma once

#include "precompute/collapse_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Marks the vertices that are copies of a cut one. `stitches`: as RepairedMesh's. Result: one flag a
/// vertex; empty without stitches.
[[nodiscard]] std::vector<std::uint8_t> mark_copies(std::span<const std::uint32_t> stitches);

/// Which vertices are copies of one vertex of the source, as far as a mesh has them.
class CutCopies
{
public:
    CutCopies() = default;

    /// `stitches`: as RepairedMesh's, or empty; must outlive this.
    explicit CutCopies(std::span<const std::uint32_t> stitches);

    /// The number of the vertex that a vertex was cut from; it may have been taken out itself.
    [[nodiscard]] std::uint32_t source(std::uint32_t vertex) const
    {
        return stitches_.empty() ? vertex : stitches_[vertex];
    }

    /// All copies, ascending, of the vertex that `vertex` is a copy of; empty when there are no others.
    [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t vertex) const;

    /// The copy that stands for all of them; the vertex itself when there are no others.
    [[nodiscard]] std::uint32_t first_of(std::uint32_t vertex) const
    {
        const auto copies = of(vertex);
        return copies.empty() ? vertex : copies.front();
    }

    /// Calls `visit` with the copies of each vertex that has several.
    template <typename Visit>
    void for_each(const Visit& visit) const
    {
        for (std::size_t i = 0; i < sources_.size(); ++i)
        {
            visit(std::span(copies_).subspan(first_[i], first_[i + 1] - first_[i]));
        }
    }

    /// Leaves out what `mesh` no longer has.
    void forget_removed(const CollapseMesh& mesh);

private:
    void group();

    std::span<const std::uint32_t> stitches_;
    std::vector<std::uint32_t> sources_;  ///< Ascending: those that have several copies.
    std::vector<std::uint32_t> first_;    ///< By source the first of its copies; then their end.
    std::vector<std::uint32_t> copies_;
};

/// Copies of one vertex that may be folded at once.
struct CopyStars
{
    static constexpr std::size_t kMost = 8;
    std::array<std::uint32_t, kMost> vertex{};
    std::array<OneRing, kMost> ring{};
    std::array<std::size_t, kMost> kept{};  ///< Number of the neighbour to fold into, see aim_at().
    std::size_t count = 0;

    /// Walks the rings of all copies of the vertex that `of` is one of. `most_neighbours`: of each.
    /// Result: false when they do not allow for a fold: too many copies or neighbours, or rings that
    /// share a vertex, so that one collapse would change what the next finds.
    [[nodiscard]] bool collect(
        const CollapseMesh& mesh,
        const CutCopies& copies,
        std::uint32_t of,
        std::uint32_t most_neighbours
    );

    /// Finds the neighbours of all copies that are copies of the vertex that `target` is one of: what is
    /// cut stays closed when all of them go there, and only then.
    /// Result: false when one of them has no such neighbour, or several, or may not go to it because it
    /// is not along its boundary.
    [[nodiscard]] bool aim_at(const CutCopies& copies, std::uint32_t target);
};

}  // namespace vsplit::precompute
