#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace vsplit {

/// Appends little-endian fields to a growing byte vector. Not thread safe.
class ByteWriter
{
public:
    /// Appends one little-endian unsigned integer of type T.
    template <typename T>
    void write(T value)
    {
        for (std::size_t i = 0; i < sizeof(T); ++i)
        {
            bytes_.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xFFU));
        }
    }

    /// Appends an IEEE-754 binary64.
    void write_f64(double value) { write(std::bit_cast<std::uint64_t>(value)); }

    /// Appends a LEB128 unsigned integer (1 to 10 bytes).
    void write_varint(std::uint64_t value)
    {
        while (value >= 0x80U)
        {
            bytes_.push_back(static_cast<std::byte>((value & 0x7FU) | 0x80U));
            value >>= 7;
        }
        bytes_.push_back(static_cast<std::byte>(value));
    }

    /// Appends raw bytes.
    void write_bytes(std::span<const std::byte> bytes)
    {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    /// Bytes written so far.
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }

    /// The bytes written so far; valid until the next write.
    [[nodiscard]] std::span<const std::byte> view() const { return bytes_; }

    /// Takes the bytes and leaves the writer empty.
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

}  // namespace vsplit
