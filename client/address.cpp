#include "address.h"

#include "wire_format.h"

#include <charconv>
#include <optional>

namespace vsplit::client {
namespace {

tl::unexpected<Error> bad(std::string_view text, const std::string& why)
{
    return fail(
        ErrorCode::BadRequest,
        "'" + std::string(text) + "' " + why +
            "; expected HOST:PORT/NAME such as localhost:7420/cow"
    );
}

std::optional<std::uint16_t> parse_port(std::string_view text)
{
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    return whole && port > 0 ? std::optional(port) : std::nullopt;
}

}  // namespace

Result<Address> parse_address(std::string_view text)
{
    const auto slash = text.find('/');
    if (slash == std::string_view::npos || slash + 1 == text.size())
    {
        return bad(text, "names no model");
    }
    Address address{{}, proto::kDefaultPort, std::string(text.substr(slash + 1))};
    std::string_view authority = text.substr(0, slash);
    std::string_view port;
    if (authority.starts_with('['))
    {
        const auto bracket = authority.find(']');
        const bool closed = bracket != std::string_view::npos;
        if (!closed || (bracket + 1 < authority.size() && authority[bracket + 1] != ':'))
        {
            return bad(text, "has a malformed [address]");
        }
        port = authority.substr(bracket + 1);
        authority = authority.substr(1, bracket - 1);
    }
    else if (const auto colon = authority.find(':'); colon != std::string_view::npos)
    {
        port = authority.substr(colon);
        authority = authority.substr(0, colon);
    }
    if (authority.empty())
    {
        return bad(text, "names no host");
    }
    address.host = authority;
    if (!port.empty())
    {
        const auto number = parse_port(port.substr(1));
        if (!number)
        {
            return bad(text, "has a port that is not 1 to 65535");
        }
        address.port = *number;
    }
    return address;
}

}  // namespace vsplit::client
