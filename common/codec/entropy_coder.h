#pragma once

#include "core/byte_writer.h"
#include "core/result.h"

#include <draco/compression/entropy/ans.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::codec {

/// Below this the state of Draco's binary rANS coder takes in its next byte.
inline constexpr std::uint32_t kLeastAnsState = 4096;

/// Rounds the probability of a one, in 1/65536, to the 8-bit probability of a zero that Draco's
/// binary rANS coder takes, in 1/256. Never 0 or 256, so every bit stays codable.
[[nodiscard]] inline std::uint8_t zero_probability(std::uint32_t one_probability)
{
    const auto zero = static_cast<std::int32_t>(256U - ((one_probability + 128U) >> 8));
    return static_cast<std::uint8_t>(std::clamp(zero, 1, 255));
}

/// Collects the bits of one chunk: modelled bits for Draco's rANS coder, which writes last to first,
/// and raw bits. Has the interface of BitDecoder, so that models are written once for both. Not
/// thread safe.
class BitEncoder
{
public:
    /// Tells templates which side they are on.
    static constexpr bool kEncodes = true;

    /// Takes one bit whose probability of being one is `one_probability` / 65536; returns it.
    bool bit(std::uint32_t one_probability, bool value)
    {
        modelled_.push_back(
            static_cast<std::uint16_t>(zero_probability(one_probability) * 2U + (value ? 1U : 0U))
        );
        return value;
    }

    /// Takes the low `count` (0 .. 32) bits of `value` as they are; returns them.
    std::uint32_t raw(std::uint32_t value, int count);

    /// Takes the bits that another encoder took.
    void append(const BitEncoder& other);

    /// Appends the chunk's bytes to `out` and forgets its bits. Precondition: none. Layout: raw part,
    /// read forwards, then rANS part, read backwards (proto/STREAM_FORMAT.md, "Bit streams").
    void finish(ByteWriter& out);

private:
    std::vector<std::uint16_t> modelled_;
    std::vector<std::byte> raw_;
    std::uint64_t pending_ = 0;
    int pending_bits_ = 0;
};

/// Reads the bits of one chunk in the order in which BitEncoder took them. Reading past the end
/// yields arbitrary bits and is reported by finish(). Not thread safe. Safe on untrusted input.
class BitDecoder
{
public:
    /// Tells templates which side they are on.
    static constexpr bool kEncodes = false;

    /// Starts on a chunk's bytes, which must outlive the decoder. Error: BadChunk.
    [[nodiscard]] Result<void> start(std::span<const std::byte> bytes);

    /// Reads one bit whose probability of being one is `one_probability` / 65536. Does what Draco's
    /// rabs_desc_read() does, but never branches on the bit, which no processor can guess.
    bool bit(std::uint32_t one_probability, bool /*value*/ = false)
    {
        const std::uint32_t share = 256U - zero_probability(one_probability);
        std::uint32_t state = ans_.state;
        if (state < kLeastAnsState && ans_.buf_offset > 0)
        {
            state = state << 8 | ans_.buf[--ans_.buf_offset];
        }
        const std::uint32_t product = (state >> 8) * share;
        const std::uint32_t rest = state & 255U;
        const bool one = rest < share;
        const std::uint32_t zero_state = state - product - share;
        const std::uint32_t difference = product + rest - zero_state;
        ans_.state = zero_state + (difference & (0U - static_cast<std::uint32_t>(one)));
        return one;
    }

    /// Reads `count` (0 .. 32) raw bits.
    std::uint32_t raw(std::uint32_t /*value*/, int count)
    {
        while (pending_bits_ < count)
        {
            const std::uint64_t byte =
                raw_position_ < raw_.size() ? static_cast<std::uint64_t>(raw_[raw_position_]) : 0U;
            pending_ |= byte << pending_bits_;
            ++raw_position_;
            pending_bits_ += 8;
        }
        const auto value = static_cast<std::uint32_t>(pending_ & ((1ULL << count) - 1ULL));
        pending_ >>= count;
        pending_bits_ -= count;
        return value;
    }

    /// Tells that more bits were read than there are, so that finish() will fail for certain.
    [[nodiscard]] bool exhausted() const
    {
        const auto end = static_cast<std::size_t>(ans_.buf_offset);
        return raw_position_ > end || (raw_position_ == end && ans_.state < kLeastAnsState);
    }

    /// Checks that exactly the chunk's bits were read. Error: BadChunk.
    [[nodiscard]] Result<void> finish() const;

private:
    draco::AnsDecoder ans_;
    std::span<const std::byte> raw_;  ///< All bytes; those at the end belong to ans_.
    std::size_t raw_position_ = 0;
    std::uint64_t pending_ = 0;
    int pending_bits_ = 0;
};

}  // namespace vsplit::codec
