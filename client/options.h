#pragma once

#include "address.h"
#include "core/result.h"
#include "device_profile.h"
#include "link_profile.h"
#include "transfer.h"
#include "view.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

namespace vsplit::client {

/// What the command line of vsplit-pda says.
struct Options
{
    Address address;
    DeviceProfile device;
    LinkProfile link;
    StopPlan stop;
    std::uint32_t frames = 10;  ///< Least frames drawn per level.
    bool render = true;
    bool wireframe = false;
    bool attributes =
        true;  ///< Colours, normals, texture coordinates, materials and images are wanted.
    UpAxis up = UpAxis::Y;
    std::filesystem::path screenshots;  ///< Folder; empty for none.
    std::filesystem::path save;         ///< PLY file; empty for none.
    std::string json;                   ///< File, "-" for standard output, empty for none.
    std::chrono::milliseconds timeout{30000};
    unsigned retries = 5;
};

/// A program that ends before it starts: help, version, or a mistake on the command line.
struct EarlyExit
{
    int status = 0;
    std::string text;
};

/// Parses the command line. `argc`, `argv`: as main() gets them.
/// Result: the options, or what to print and the exit status (0 help, 2 usage, 5 an unreadable file).
[[nodiscard]] std::variant<Options, EarlyExit> parse_options(int argc, const char* const* argv);

}  // namespace vsplit::client
