#include "device_profile.h"

#include "core/file_io.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

namespace vsplit::client {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxDeviceFileBytes = 64U * 1024U;
constexpr std::size_t kMaxNameLength = 64;

struct Bounds
{
    const char* field;
    std::uint64_t low;
    std::uint64_t high;
};

// OpenGL ES 3 drivers commonly draw up to 4096 pixels; less than 64 KiB would not even hold a base
// mesh and its decoder.
constexpr Bounds kWidth{"width", 16, 4096};
constexpr Bounds kHeight{"height", 16, 4096};
constexpr Bounds kMemory{"memory_bytes", 1U << 16, std::uint64_t{1} << 40};
constexpr Bounds kBudget{"frame_budget_ms", 1, 60000};
constexpr Bounds kTextureLimit{"texture_limit", 0, 32768};

tl::unexpected<Error> bad(const std::string& why)
{
    return fail(ErrorCode::UnsupportedInput, "the device description " + why);
}

Result<std::uint64_t> read_field(const json& object, const Bounds& bounds)
{
    const auto found = object.find(bounds.field);
    if (found == object.end())
    {
        return bad(std::string("lacks \"") + bounds.field + "\"");
    }
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() < bounds.low ||
        found->get<std::uint64_t>() > bounds.high)
    {
        return bad(
            std::string("has a \"") + bounds.field + "\" that is not a whole number from " +
            std::to_string(bounds.low) + " to " + std::to_string(bounds.high)
        );
    }
    return found->get<std::uint64_t>();
}

Result<void> check_fields(const json& object)
{
    constexpr std::array<std::string_view, 6> kKnown{
        "name", kWidth.field, kHeight.field, kMemory.field, kBudget.field, kTextureLimit.field};
    for (const auto& item : object.items())
    {
        if (std::find(kKnown.begin(), kKnown.end(), item.key()) == kKnown.end())
        {
            return bad("has an unknown field \"" + item.key() + "\"");
        }
    }
    const auto name = object.find("name");
    if (name != object.end() && (!name->is_string() || name->get<std::string>().empty() ||
                                 name->get<std::string>().size() > kMaxNameLength))
    {
        return bad("has a \"name\" that is not 1 to 64 characters");
    }
    return {};
}

}  // namespace

Result<DeviceProfile> parse_device(std::string_view text)
{
    const json object = json::parse(text, nullptr, false);
    if (!object.is_object())
    {
        return bad("is not a JSON object");
    }
    VSPLIT_TRY(check_fields(object));
    DeviceProfile device;
    device.name = object.value("name", std::string("custom"));
    const auto width = read_field(object, kWidth);
    VSPLIT_TRY(width);
    const auto height = read_field(object, kHeight);
    VSPLIT_TRY(height);
    const auto memory = read_field(object, kMemory);
    VSPLIT_TRY(memory);
    const auto budget = read_field(object, kBudget);
    VSPLIT_TRY(budget);
    device.width = static_cast<std::uint32_t>(*width);
    device.height = static_cast<std::uint32_t>(*height);
    device.memory_bytes = *memory;
    device.frame_budget = std::chrono::milliseconds(*budget);
    if (object.contains(kTextureLimit.field))
    {
        const auto limit = read_field(object, kTextureLimit);
        VSPLIT_TRY(limit);
        device.texture_limit = static_cast<std::uint32_t>(*limit);
    }
    return device;
}

Result<DeviceProfile> load_device(std::string_view name_or_file)
{
    using std::chrono::milliseconds;
    if (name_or_file == "pda")
    {
        return DeviceProfile{};
    }
    if (name_or_file == "phone")
    {
        return DeviceProfile{"phone", 720, 1280, 256U << 20, milliseconds(33), 2048};
    }
    if (name_or_file == "tablet")
    {
        return DeviceProfile{"tablet", 1280, 800, 1U << 30, milliseconds(16), 4096};
    }
    const auto bytes = read_file(std::filesystem::path(name_or_file), kMaxDeviceFileBytes);
    if (!bytes)
    {
        return fail(
            bytes.error().code,
            bytes.error().message + "; --device takes pda, phone, tablet or a JSON file"
        );
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    return parse_device(text).map_error([&](Error error) {
        error.message = std::string(name_or_file) + ": " + error.message;
        return error;
    });
}

}  // namespace vsplit::client
