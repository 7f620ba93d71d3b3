#include "address.h"
#include "device_profile.h"
#include "options.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace vsplit::client {
namespace {

std::variant<Options, EarlyExit> parse(std::vector<const char*> arguments)
{
    arguments.insert(arguments.begin(), "vsplit-pda");
    return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

int exit_of(std::vector<const char*> arguments)
{
    const auto parsed = parse(std::move(arguments));
    const auto* exit = std::get_if<EarlyExit>(&parsed);
    return exit == nullptr ? -1 : exit->status;
}

constexpr const char* kGoodDevice =
    R"({"name": "watch", "width": 176, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})";

TEST(DeviceProfile, KnowsItsNames)
{
    const auto pda = load_device("pda");
    ASSERT_TRUE(pda.has_value());
    EXPECT_EQ(pda->width, 240U);
    EXPECT_EQ(pda->height, 320U);
    EXPECT_EQ(pda->memory_bytes, 16U << 20);
    EXPECT_EQ(pda->texture_limit, 512U);
    EXPECT_EQ(load_device("phone")->texture_limit, 2048U);
    EXPECT_EQ(load_device("phone")->name, "phone");
    EXPECT_EQ(load_device("tablet")->name, "tablet");
}

TEST(DeviceProfile, ReadsAFile)
{
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("device" + std::to_string(::getpid()) + ".json");
    std::ofstream(path) << kGoodDevice;
    const auto device = load_device(path.string());
    std::filesystem::remove(path);
    ASSERT_TRUE(device.has_value());
    EXPECT_EQ(device->name, "watch");
    EXPECT_EQ(device->width, 176U);
    EXPECT_EQ(device->height, 220U);
    EXPECT_EQ(device->memory_bytes, 1000000U);
    EXPECT_EQ(device->frame_budget, std::chrono::milliseconds(50));
}

TEST(DeviceProfile, MaySayHowLargeTexturesAre)
{
    const std::string text(kGoodDevice);
    EXPECT_EQ(parse_device(text)->texture_limit, DeviceProfile{}.texture_limit);
    const std::string start = text.substr(0, text.size() - 1);
    const auto device = parse_device(start + R"(, "texture_limit": 128})");
    ASSERT_TRUE(device.has_value());
    EXPECT_EQ(device->texture_limit, 128U);
    EXPECT_EQ(parse_device(start + R"(, "texture_limit": 0})")->texture_limit, 0U);
    EXPECT_FALSE(parse_device(start + R"(, "texture_limit": 32769})").has_value());
    EXPECT_FALSE(parse_device(start + R"(, "texture_limit": "big"})").has_value());
}

TEST(DeviceProfile, SaysThatAFileIsMissing)
{
    const auto device = load_device("/nonexistent/device.json");
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().code, ErrorCode::NotFound);
}

TEST(DeviceProfile, RefusesEveryTruncationOfAFile)
{
    const std::string good = kGoodDevice;
    ASSERT_TRUE(parse_device(good).has_value());
    for (std::size_t length = 0; length < good.size(); ++length)
    {
        const auto device = parse_device(std::string_view(good).substr(0, length));
        ASSERT_FALSE(device.has_value()) << length;
        EXPECT_EQ(device.error().code, ErrorCode::UnsupportedInput);
    }
}

TEST(DeviceProfile, RefusesFieldsThatAreMissingUnknownOrOutOfRange)
{
    for (const std::string text :
         {R"([])",
          R"({"width": 176, "height": 220, "memory_bytes": 1000000})",
          R"({"width": 0, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"width": -176, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"width": 176.5, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"width": "176", "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"width": 1e30, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"width": 176, "height": 4097, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"width": 176, "height": 220, "memory_bytes": 1, "frame_budget_ms": 50})",
          R"({"width": 176, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 0})",
          R"({"width": 176, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50, "hieght": 1})",
          R"({"name": 7, "width": 176, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})",
          R"({"name": "", "width": 176, "height": 220, "memory_bytes": 1000000, "frame_budget_ms": 50})"})
    {
        const auto device = parse_device(text);
        ASSERT_FALSE(device.has_value()) << text;
        EXPECT_EQ(device.error().code, ErrorCode::UnsupportedInput) << text;
    }
}

TEST(Address, ReadsHostPortAndName)
{
    const auto address = parse_address("example.org:81/scans/cow.ply");
    ASSERT_TRUE(address.has_value());
    EXPECT_EQ(address->host, "example.org");
    EXPECT_EQ(address->port, 81);
    EXPECT_EQ(address->model, "scans/cow.ply");
}

TEST(Address, ReadsNumericAddressesAndTheDefaultPort)
{
    EXPECT_EQ(parse_address("[::1]:9000/a")->host, "::1");
    EXPECT_EQ(parse_address("[::1]:9000/a")->port, 9000);
    EXPECT_EQ(parse_address("[::1]/a")->port, 7420);
    EXPECT_EQ(parse_address("127.0.0.1/a")->port, 7420);
}

TEST(Address, RefusesWhatNamesNoHostPortOrModel)
{
    for (const std::string text :
         {"",
          "host",
          "host:1",
          "host:1/",
          "/a",
          ":1/a",
          "host:/a",
          "host:0/a",
          "host:65536/a",
          "host:x/a",
          "host:1:2/a",
          "[::1/a",
          "[::1]x/a",
          "[]:1/a"})
    {
        const auto address = parse_address(text);
        ASSERT_FALSE(address.has_value()) << text;
        EXPECT_EQ(address.error().code, ErrorCode::BadRequest) << text;
    }
}

TEST(Options, ReadEverything)
{
    const auto parsed =
        parse({"h:1/m",     "--device",    "phone",         "--link", "gprs",    "--frames",
               "3",         "--wireframe", "--screenshots", "shots",  "--save",  "out.ply",
               "--json",    "-",           "--level",       "4",      "--error", "0.25%",
               "--timeout", "2.5",         "--retries",     "7",      "--up",    "z"});
    const auto* options = std::get_if<Options>(&parsed);
    ASSERT_NE(options, nullptr);
    EXPECT_EQ(options->device.name, "phone");
    EXPECT_EQ(options->link.name, "gprs");
    EXPECT_EQ(options->frames, 3U);
    EXPECT_TRUE(options->wireframe);
    EXPECT_EQ(options->screenshots, "shots");
    EXPECT_EQ(options->save, "out.ply");
    EXPECT_EQ(options->json, "-");
    EXPECT_EQ(options->stop.condition.level, 4U);
    EXPECT_TRUE(options->stop.error_in_percent);
    EXPECT_DOUBLE_EQ(options->stop.condition.error, 0.25);
    EXPECT_EQ(options->timeout, std::chrono::milliseconds(2500));
    EXPECT_EQ(options->retries, 7U);
    EXPECT_EQ(options->up, UpAxis::Z);
}

TEST(Options, SayWhatOfTheAppearanceIsWanted)
{
    const auto all = parse({"h:1/m", "--device", "phone"});
    EXPECT_TRUE(std::get<Options>(all).attributes);
    EXPECT_EQ(std::get<Options>(all).device.texture_limit, 2048U);
    const auto less = parse({"h:1/m", "--device", "phone", "--texture-limit", "300"});
    EXPECT_EQ(std::get<Options>(less).device.texture_limit, 300U);
    EXPECT_FALSE(std::get<Options>(parse({"h:1/m", "--no-attributes"})).attributes);
    EXPECT_EQ(exit_of({"h:1/m", "--texture-limit", "40000"}), 2);
}

TEST(Options, TakeAnErrorOfZeroForNoStop)
{
    const auto parsed = parse({"h:1/m", "--error", "0"});
    const auto* options = std::get_if<Options>(&parsed);
    ASSERT_NE(options, nullptr);
    EXPECT_LT(options->stop.condition.error, 0.0);
}

TEST(Options, EndWithTheStatusForUsageOnAMistake)
{
    EXPECT_EQ(exit_of({}), 2);
    EXPECT_EQ(exit_of({"nohost"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--link", "5g"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--frames", "0"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--error", "-1"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--error", "nan"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--error", "%"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--level", "-1"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--timeout", "0"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--no-render", "--screenshots", "x"}), 2);
    EXPECT_EQ(exit_of({"h:1/m", "--device", "/nonexistent.json"}), 5);
    EXPECT_EQ(exit_of({"--help"}), 0);
    EXPECT_EQ(exit_of({"--version"}), 0);
}

}  // namespace
}  // namespace vsplit::client
