#include "link_profile.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace vsplit::client {
namespace {

struct NamedLink
{
    std::string_view name;
    double kilobits_per_second;
    int latency_ms;
};

// Downstream rates and round trips that users of the time could count on, not the best case:
// modem28  ITU-T V.34 at 28 800 bit/s, the link of the 2004 setting; about 100 ms through a modem pair.
// gprs     coding scheme CS-2, three time slots of 13.4 kbit/s (3GPP TS 43.064); about 600 ms.
// edge     MCS-6 in four slots of 29.6 kbit/s (3GPP TS 43.064); about 300 ms.
// 3g       "Regular 3G", 4g and wifi: loaded cells and a shared access point, in the order of the
//          figures that WebPageTest and the Chrome developer tools use for these names.
constexpr std::array<NamedLink, 6> kLinks{{
    {"modem28", 28.8, 100},
    {"gprs", 40.0, 600},
    {"edge", 120.0, 300},
    {"3g", 1600.0, 150},
    {"4g", 12000.0, 50},
    {"wifi", 40000.0, 5},
}};

constexpr double kMaxKilobits = 1e7;
constexpr double kMinKilobits = 0.1;
constexpr int kMaxLatencyMs = 60000;

LinkProfile make_link(std::string_view name, double kilobits, int latency_ms)
{
    return {std::string(name), kilobits * 1000.0 / 8.0, std::chrono::milliseconds(latency_ms)};
}

template <typename T>
std::optional<T> parse_number(std::string_view text)
{
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
    {
        return std::nullopt;
    }
    return value;
}

}  // namespace

Result<LinkProfile> parse_link(std::string_view text)
{
    if (text == "none")
    {
        return LinkProfile{};
    }
    for (const NamedLink& link : kLinks)
    {
        if (link.name == text)
        {
            return make_link(link.name, link.kilobits_per_second, link.latency_ms);
        }
    }
    const auto colon = text.find(':');
    const auto kilobits = parse_number<double>(text.substr(0, colon));
    const auto latency =
        colon == std::string_view::npos ? std::nullopt : parse_number<int>(text.substr(colon + 1));
    // The comparison is written so that NaN fails it.
    if (kilobits && latency && *kilobits >= kMinKilobits && *kilobits <= kMaxKilobits &&
        *latency >= 0 && *latency <= kMaxLatencyMs)
    {
        return make_link(text, *kilobits, *latency);
    }
    return fail(
        ErrorCode::UnsupportedInput,
        "unknown link '" + std::string(text) +
            "'; use none, modem28, gprs, edge, 3g, 4g, wifi or KBITS:LATENCY_MS such as 256:80"
    );
}

std::size_t receive_buffer_bytes(const LinkProfile& link)
{
    if (link.bytes_per_second <= 0.0)
    {
        return 0;
    }
    return static_cast<std::size_t>(std::clamp(link.bytes_per_second * 0.5, 4096.0, 256.0 * 1024.0)
    );
}

}  // namespace vsplit::client
