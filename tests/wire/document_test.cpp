#include "core/error.h"
#include "wire/frame.h"
#include "wire/message.h"
#include "wire_format.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <map>
#include <regex>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace vsplit {
namespace {

std::string read_document()
{
    std::ifstream file(VSPLIT_SOURCE_DIR "/proto/WIRE_PROTOCOL.md");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Collects name -> number from the table rows that `row` matches.
std::map<std::string, unsigned long> rows(const std::string& text, const std::regex& row, int base)
{
    std::map<std::string, unsigned long> found;
    for (std::sregex_iterator i(text.begin(), text.end(), row), end; i != end; ++i)
    {
        found[(*i)[2].str()] = std::stoul((*i)[1].str(), nullptr, base);
    }
    return found;
}

TEST(WireProtocolDocument, NamesEveryFrameTypeWithItsNumber)
{
    using proto::FrameType;
    const std::map<std::string, unsigned long> expected{
        {"Open", static_cast<unsigned long>(FrameType::Open)},
        {"Pause", static_cast<unsigned long>(FrameType::Pause)},
        {"Resume", static_cast<unsigned long>(FrameType::Resume)},
        {"Cancel", static_cast<unsigned long>(FrameType::Cancel)},
        {"Ping", static_cast<unsigned long>(FrameType::Ping)},
        {"ModelInfo", static_cast<unsigned long>(FrameType::ModelInfo)},
        {"Data", static_cast<unsigned long>(FrameType::Data)},
        {"Done", static_cast<unsigned long>(FrameType::Done)},
        {"Failure", static_cast<unsigned long>(FrameType::Failure)},
        {"Pong", static_cast<unsigned long>(FrameType::Pong)},
        {"Waiting", static_cast<unsigned long>(FrameType::Waiting)},
    };
    const std::regex row(R"(\| 0x([0-9A-F]{2}) \| (\w+) \|)");
    EXPECT_EQ(rows(read_document(), row, 16), expected);
}

TEST(WireProtocolDocument, GivesTheLimitsThatTheCodeObeys)
{
    const std::map<std::string, unsigned long> expected{
        {"kWireVersion", proto::kWireVersion},
        {"kDefaultPort", proto::kDefaultPort},
        {"kFrameHeaderBytes", proto::kFrameHeaderBytes},
        {"kMaxControlBytes", proto::kMaxControlBytes},
        {"kMaxDataBytes", proto::kMaxDataBytes},
        {"kSentDataBytes", proto::kSentDataBytes},
        {"kMaxTextBytes", proto::kMaxTextBytes},
        {"kPingBytes", proto::kPingBytes},
    };
    const std::regex row(R"(\| (\d+) \| `(k\w+)` \|)");
    EXPECT_EQ(rows(read_document(), row, 10), expected);
}

TEST(WireProtocolDocument, NamesEveryErrorCodeThatItUses)
{
    const std::regex row(R"(\| (\d+) \| ([a-z-]+) \|)");
    const auto found = rows(read_document(), row, 10);
    EXPECT_GE(found.size(), 15U);
    for (const auto& [name, number] : found)
    {
        EXPECT_EQ(error_name(static_cast<ErrorCode>(number)), name);
    }
}

/// Collects the hexadecimal bytes that indented lines after `heading` begin with.
std::vector<std::byte> hex_after(const std::string& text, const std::string& heading)
{
    const std::string part = text.substr(text.find(heading));
    const std::regex line(R"(\n    ((?:[0-9a-f]{2}  ?)*[0-9a-f]{2}))");
    const std::regex byte("[0-9a-f]{2}");
    std::vector<std::byte> bytes;
    for (std::sregex_iterator i(part.begin(), part.end(), line), end; i != end; ++i)
    {
        const std::string found = (*i)[1].str();
        for (std::sregex_iterator j(found.begin(), found.end(), byte); j != end; ++j)
        {
            bytes.push_back(static_cast<std::byte>(std::stoul(j->str(), nullptr, 16)));
        }
    }
    return bytes;
}

void append(std::vector<std::byte>& to, std::span<const std::byte> more)
{
    to.insert(to.end(), more.begin(), more.end());
}

TEST(WireProtocolDocument, ShowsInItsExampleWhatTheCodeSends)
{
    wire::Open open{.model = "cow"};
    open.stop.level = 3;
    std::vector<std::byte> expected = encode(open).value();
    const wire::ModelInfo info{
        .content_id = 0x1122334455667788U, .file_bytes = 5000, .start = 0, .end = 1100};
    append(expected, encode(info));
    append(expected, wire::frame_header(wire::FrameType::Data, 1100));
    append(expected, encode(wire::Done{}));
    EXPECT_EQ(hex_after(read_document(), "## Worked example"), expected);
}

}  // namespace
}  // namespace vsplit
