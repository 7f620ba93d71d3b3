#include "core/crc32c.h"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string_view>

namespace vsplit {
namespace {

std::span<const std::byte> as_bytes(std::string_view text)
{
    return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(Crc32c, GivesTheCatalogueCheckValue)
{
    EXPECT_EQ(crc32c(as_bytes("123456789")), 0xE3069283U);
}

// RFC 3720, appendix B.4.
TEST(Crc32c, GivesTheValuesOfRfc3720)
{
    std::array<std::byte, 32> bytes{};
    EXPECT_EQ(crc32c(bytes), 0x8A9136AAU);
    bytes.fill(std::byte{0xFF});
    EXPECT_EQ(crc32c(bytes), 0x62A8AB43U);
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        bytes[i] = static_cast<std::byte>(i);
    }
    EXPECT_EQ(crc32c(bytes), 0x46DD794EU);
}

TEST(Crc32c, OfNothingIsZero)
{
    EXPECT_EQ(crc32c({}), 0U);
}

TEST(Crc32c, ContinuesOverPieces)
{
    const std::string_view text = "every prefix is a usable mesh";
    const auto whole = crc32c(as_bytes(text));
    for (std::size_t cut = 0; cut <= text.size(); ++cut)
    {
        const auto first = crc32c(as_bytes(text.substr(0, cut)));
        EXPECT_EQ(crc32c(as_bytes(text.substr(cut)), first), whole) << cut;
    }
}

}  // namespace
}  // namespace vsplit
