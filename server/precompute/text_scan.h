#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vsplit::precompute {

/// Walks over the lines of a text. Lines end at "\n", "\r\n" or "\r". Not thread safe. Safe on untrusted
/// input.
class LineReader
{
public:
    /// Starts before the first line of `text`, which must outlive the reader.
    explicit LineReader(std::string_view text) : text_(text) {}

    /// Takes the next line without its end; nothing after the last one.
    [[nodiscard]] std::optional<std::string_view> next();

    /// Number of the line that next() gave last, from 1.
    [[nodiscard]] std::size_t line_number() const { return line_number_; }

    /// Byte offset of the line after it.
    [[nodiscard]] std::size_t offset() const { return offset_; }

private:
    std::string_view text_;
    std::size_t offset_ = 0;
    std::size_t newline_ =
        0;  ///< First "\n" from offset_ on, kept so that it is searched for once.
    std::size_t line_number_ = 0;
};

/// Takes the next run of non-blank characters off the front of `text`; empty at its end. Cost: linear
/// in what it takes. Thread safe. Safe on untrusted input.
[[nodiscard]] std::string_view take_token(std::string_view& text);

/// Reads a whole token as a decimal number; "nan" and "inf" are numbers too. Nothing when the token
/// is anything else. Independent of the locale. Thread safe. Safe on untrusted input.
[[nodiscard]] std::optional<double> parse_real(std::string_view token);

/// Reads a whole token as a decimal integer of at most 64 bits; nothing when it is anything else.
/// Thread safe. Safe on untrusted input.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);

/// Turns A-Z into a-z and leaves everything else alone. Independent of the locale. Thread safe.
[[nodiscard]] std::string lower_case(std::string_view word);

/// Says a number of bytes in words for messages, e.g. "1 kB". Thread safe.
[[nodiscard]] std::string size_in_words(std::uint64_t bytes);

}  // namespace vsplit::precompute
