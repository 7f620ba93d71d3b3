#pragma once

#include "codec/split_cost.h"
#include "format.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vsplit::codec {

/// Decides into how many chunks the levels of a stream are cut. Not thread safe.
class LevelCutter
{
public:
    /// `vertices`: of the complete mesh.
    explicit LevelCutter(std::uint32_t vertices) : cuts_left_(vertices / kVerticesPerCut) {}

    /// What splits are expected to cost.
    [[nodiscard]] SplitCost& cost() { return cost_; }

    /// Chunks to cut a level into: each may grow the prefix by a sixth while that is short, by a twelfth
    /// later, as long as that does not cost too much; cut for the target they are in any case.
    /// `refinement`: bits that the level's start takes; `payload`: bytes of all chunks before.
    [[nodiscard]] std::uint32_t chunk_count(
        std::uint32_t splits, std::uint64_t refinement, std::size_t payload
    )
    {
        const std::size_t prefix = kHeaderBytes + payload;
        const std::size_t most = std::clamp<std::size_t>(
            prefix / 12, std::min(prefix / 6, kSmallestChunkBytes), kFullChunkBytes
        );
        const std::uint64_t bytes = (cost_.bits_for(splits) + refinement) / 8;
        const auto cuts_to = [bytes](std::size_t length) {
            return static_cast<std::uint32_t>(std::max<std::uint64_t>(bytes / length, 1) - 1);
        };
        const auto cuts = std::max(cuts_to(kFullChunkBytes), std::min(cuts_to(most), cuts_left_));
        cuts_left_ -= std::min(cuts, cuts_left_);
        return cuts + 1;
    }

private:
    /// What header and index of a small stream take.
    static constexpr std::size_t kHeaderBytes = 90;

    /// A chunk costs about seven bytes of its own; where the prefix is long, shorter ones bring nothing.
    static constexpr std::size_t kSmallestChunkBytes = 700;

    /// Length to cut for when a level is long: estimates are off by less than what is left to the
    /// target.
    static constexpr std::size_t kFullChunkBytes = proto::kTargetChunkBytes * 5ULL / 8;

    /// Vertices for each chunk that levels may be cut into beyond the first: half a percent of the file.
    static constexpr std::uint32_t kVerticesPerCut = 600;

    SplitCost cost_;
    std::uint32_t cuts_left_;  ///< Of levels into chunks.
};

}  // namespace vsplit::codec
