#pragma once

#include <algorithm>
#include <cstdint>

namespace vsplit::codec {

/// Bytes of a chunk that do not depend on its splits: the checksum and the ends of its bit streams.
inline constexpr std::uint32_t kChunkOverheadBytes = 6;

/// Bits that a level's start is expected to take when `vertices` known vertices get `drop` more bits of
/// precision an axis: more where a level before may have shown vertices outside of their own cells.
/// `shift`: of the level before.
[[nodiscard]] inline std::uint64_t refinement_bits(std::uint32_t vertices, int shift, int drop)
{
    constexpr int kLeastShiftOfMoved = 2;
    return (shift >= kLeastShiftOfMoved ? 9ULL : 6ULL) * vertices *
           static_cast<std::uint32_t>(drop) / 2;
}

/// Raw bits that a level's start puts into one chunk, so that the chunk stays below its greatest length.
inline constexpr std::uint32_t kRefinementBits = 1U << 18;

/// Most vertices that one chunk brings `steps` (at least 1) more bits of precision an axis.
[[nodiscard]] constexpr std::uint32_t refined_per_chunk(int steps)
{
    return kRefinementBits / (3U * static_cast<std::uint32_t>(steps));
}

/// What splits have cost so far, from which rows predict lengths and the encoder cuts levels into
/// chunks. Source: proto/STREAM_FORMAT.md, "Rows".
class SplitCost
{
public:
    /// Bits that `splits` (at most 2^28) will cost.
    [[nodiscard]] std::uint64_t bits_for(std::uint64_t splits) const
    {
        return splits * bits_ / splits_;
    }

    /// Splits of the next of `chunks` (at least 1) chunks of equal length that hold `splits` splits and,
    /// in the next one, `refinement` bits besides.
    [[nodiscard]] std::uint32_t next_share(
        std::uint32_t splits, std::uint32_t chunks, std::uint64_t refinement
    ) const
    {
        const std::uint64_t share = (bits_for(splits) + refinement) / chunks;
        const std::uint64_t left = share - std::min(share, refinement);
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(left * splits_ / bits_, splits));
    }

    /// Length to be expected of a chunk, bytes.
    [[nodiscard]] std::uint32_t chunk_bytes(std::uint32_t splits, std::uint64_t refinement) const
    {
        const std::uint64_t bytes = (bits_for(splits) + refinement + 7) / 8 + kChunkOverheadBytes;
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(bytes, kMostBytes));
    }

    /// Takes note of a level that adds `drop` bits of precision: more than two at once do not come with
    /// as many finer splits, so that each split pays for them.
    void expect_drop(int drop)
    {
        bits_ += splits_ * 3 * static_cast<std::uint64_t>(std::max(drop - 2, 0));
    }

    /// Takes note of a chunk that has splits.
    void observe(std::uint32_t splits, std::uint32_t bytes, std::uint64_t refinement)
    {
        if (splits == 0)
        {
            return;
        }
        const std::uint64_t fixed = refinement + 8ULL * kChunkOverheadBytes;
        const std::uint64_t bits = 8ULL * bytes - std::min<std::uint64_t>(8ULL * bytes, fixed);
        bits_ += std::max<std::uint64_t>(bits, 2ULL * splits);
        splits_ += splits;
        for (; splits_ >= kMemory; splits_ /= 2)
        {
            bits_ /= 2;
        }
    }

private:
    static constexpr std::uint64_t kMostBytes = 1U << 28;
    static constexpr std::uint64_t kMemory = 256;

    std::uint64_t bits_ = 320;  ///< Of the chunks before, the last ones counting most.
    std::uint64_t splits_ = 16;
};

}  // namespace vsplit::codec
