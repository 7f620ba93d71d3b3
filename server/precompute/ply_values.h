#pragma once

#include "precompute/ply_header.h"
#include "precompute/text_scan.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace vsplit::precompute {

/// Values of a binary body of a PLY file, in file order. Not thread safe. Safe on untrusted input.
class BinaryValues
{
public:
    /// Starts at `offset`, which is at most the size of `bytes`; these must outlive the reader.
    BinaryValues(std::span<const std::byte> bytes, std::size_t offset, bool big_endian)
        : bytes_(bytes), offset_(offset), big_endian_(big_endian)
    {
    }

    /// Byte offset of the next value.
    [[nodiscard]] std::size_t offset() const { return offset_; }

    /// Bytes left.
    [[nodiscard]] std::size_t left() const { return bytes_.size() - offset_; }

    /// Bytes that a value takes at least.
    static std::size_t smallest(PlyType type) { return ply_type_bytes(type); }

    /// Passes over a value; false when there is none.
    bool skip(PlyType type) { return take(ply_type_bytes(type)); }

    /// Takes a value; nothing when there is none.
    std::optional<double> number(PlyType type)
    {
        const std::size_t size = ply_type_bytes(type);
        if (!take(size))
        {
            return std::nullopt;
        }
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i)
        {
            const std::size_t place = big_endian_ ? size - 1 - i : i;
            bits |= static_cast<std::uint64_t>(bytes_[offset_ - size + i]) << (8 * place);
        }
        return convert(type, bits);
    }

private:
    bool take(std::size_t size)
    {
        const bool there = size <= left();
        offset_ += there ? size : 0;
        return there;
    }

    static double convert(PlyType type, std::uint64_t bits)
    {
        switch (type)
        {
            case PlyType::Int8:
                return static_cast<std::int8_t>(bits);
            case PlyType::Int16:
                return static_cast<std::int16_t>(bits);
            case PlyType::Int32:
                return static_cast<std::int32_t>(bits);
            case PlyType::Float32:
                return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
            case PlyType::Float64:
                return std::bit_cast<double>(bits);
            case PlyType::Uint8:
            case PlyType::Uint16:
            case PlyType::Uint32:
                break;
        }
        return static_cast<double>(bits);
    }

    std::span<const std::byte> bytes_;
    std::size_t offset_;
    bool big_endian_;
};

/// Values of an ascii body of a PLY file, in file order; lines do not matter. Not thread safe. Safe on
/// untrusted input.
class AsciiValues
{
public:
    /// Starts at `offset`, which is at most the size of `text`; this must outlive the reader.
    AsciiValues(std::string_view text, std::size_t offset)
        : rest_(text.substr(offset)), size_(text.size())
    {
    }

    /// Byte offset of the next value.
    [[nodiscard]] std::size_t offset() const { return size_ - rest_.size(); }

    /// One more than the characters left: the last value needs no blank behind it.
    [[nodiscard]] std::size_t left() const { return rest_.size() + 1; }

    /// Bytes that a value takes at least: a digit and a blank.
    static std::size_t smallest(PlyType /*type*/) { return 2; }

    /// Passes over a value; false when there is none.
    bool skip(PlyType /*type*/) { return !take_token(rest_).empty(); }

    /// Takes a value; nothing when there is none.
    std::optional<double> number(PlyType /*type*/) { return parse_real(take_token(rest_)); }

private:
    std::string_view rest_;
    std::size_t size_;
};

}  // namespace vsplit::precompute
