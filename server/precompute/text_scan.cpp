#include "precompute/text_scan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace vsplit::precompute {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// std::from_chars takes no leading plus sign, mesh files do use it.
std::string_view without_plus(std::string_view token)
{
    const bool signed_twice = token.size() > 1 && (token[1] == '-' || token[1] == '+');
    if (!token.empty() && token.front() == '+' && !signed_twice)
    {
        token.remove_prefix(1);
    }
    return token;
}

}  // namespace

std::optional<std::string_view> LineReader::next()
{
    if (offset_ >= text_.size())
    {
        return std::nullopt;
    }
    if (newline_ < offset_ || offset_ == 0)
    {
        newline_ = std::min(text_.find('\n', offset_), text_.size());
    }
    const std::string_view line = text_.substr(offset_, newline_ - offset_);
    const std::size_t length = std::min(line.find('\r'), line.size());
    offset_ += length + 1;
    if (length < line.size() && offset_ == newline_)
    {
        ++offset_;  // "\r\n" is one end
    }
    offset_ = std::min(offset_, text_.size());
    ++line_number_;
    return line.substr(0, length);
}

std::string_view take_token(std::string_view& text)
{
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos)
    {
        text = {};
        return {};
    }
    text.remove_prefix(begin);
    const std::size_t length = std::min(text.find_first_of(kBlanks), text.size());
    const std::string_view token = text.substr(0, length);
    text.remove_prefix(length);
    return token;
}

std::optional<double> parse_real(std::string_view token)
{
    token = without_plus(token);
    double value = 0.0;
    const char* const end = token.data() + token.size();
    const auto [stop, error] = std::from_chars(token.data(), end, value);
    if (token.empty() || stop != end)
    {
        return std::nullopt;
    }
    if (error == std::errc::result_out_of_range)
    {
        // Either too large for a double or so small that it is zero; from_chars does not say which.
        const std::size_t exponent = token.find_first_of("eE");
        const bool tiny = exponent == token.npos
                              ? token.find_first_of("123456789") > token.find('.')
                              : token.substr(exponent + 1).starts_with('-');
        return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return error == std::errc{} ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view token)
{
    token = without_plus(token);
    std::int64_t value = 0;
    const char* const end = token.data() + token.size();
    const auto [stop, error] = std::from_chars(token.data(), end, value);
    if (token.empty() || stop != end || error != std::errc{})
    {
        return std::nullopt;
    }
    return value;
}

std::string lower_case(std::string_view word)
{
    std::string result(word);
    std::transform(result.begin(), result.end(), result.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return result;
}

std::string size_in_words(std::uint64_t bytes)
{
    if (bytes < 1000)
    {
        return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
    }
    const bool mega = bytes >= 1000000;
    const double unit = mega ? 1e6 : 1e3;
    return std::to_string(std::llround(static_cast<double>(bytes) / unit)) + (mega ? " MB" : " kB");
}

}  // namespace vsplit::precompute
