#pragma once

#include "core/result.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit {

/// Reads little-endian fields from untrusted bytes; every read is checked against the bytes left.
/// Not thread safe. Safe on untrusted input.
class ByteReader
{
public:
    /// Starts at the first byte of `bytes`, which must outlive the reader. `base_offset` is added to
    /// the offsets that errors report.
    explicit ByteReader(std::span<const std::byte> bytes, std::uint64_t base_offset = 0)
        : bytes_(bytes), base_offset_(base_offset)
    {
    }

    /// Bytes not read yet.
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }

    /// Bytes read so far.
    [[nodiscard]] std::size_t position() const { return position_; }

    /// Reads one little-endian unsigned integer of type T. Error: Truncated.
    template <typename T>
    [[nodiscard]] Result<T> read()
    {
        if (remaining() < sizeof(T))
        {
            return truncated();
        }
        T value = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
        {
            value = static_cast<T>(
                value | static_cast<T>(static_cast<T>(bytes_[position_ + i]) << (8 * i))
            );
        }
        position_ += sizeof(T);
        return value;
    }

    /// Reads an IEEE-754 binary64. Error: Truncated.
    [[nodiscard]] Result<double> read_f64()
    {
        return read<std::uint64_t>().map([](std::uint64_t bits) {
            return std::bit_cast<double>(bits);
        });
    }

    /// Reads a LEB128 unsigned integer of at most 64 bits, shortest form not required.
    /// Errors: Truncated, BadHeader when it exceeds 64 bits.
    [[nodiscard]] Result<std::uint64_t> read_varint()
    {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7)
        {
            if (remaining() == 0)
            {
                return truncated();
            }
            const auto byte = static_cast<std::uint64_t>(bytes_[position_++]);
            if (shift == 63 && byte > 1)
            {
                break;
            }
            value |= (byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0)
            {
                return value;
            }
        }
        return fail(ErrorCode::BadHeader, "a variable-length integer is too long", offset());
    }

    /// Takes the next `count` bytes as a view. Error: Truncated.
    [[nodiscard]] Result<std::span<const std::byte>> read_bytes(std::size_t count)
    {
        if (remaining() < count)
        {
            return truncated();
        }
        const auto view = bytes_.subspan(position_, count);
        position_ += count;
        return view;
    }

private:
    [[nodiscard]] std::uint64_t offset() const { return base_offset_ + position_; }

    [[nodiscard]] tl::unexpected<Error> truncated() const
    {
        return fail(ErrorCode::Truncated, "the data end too early", offset());
    }

    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
    std::uint64_t base_offset_ = 0;
};

}  // namespace vsplit
