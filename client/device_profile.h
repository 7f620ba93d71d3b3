#pragma once

#include "core/result.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace vsplit::client {

/// What the simulated device can do.
struct DeviceProfile
{
    std::string name = "pda";
    std::uint32_t width = 240;   ///< Screen, pixels.
    std::uint32_t height = 320;  ///< Screen, pixels.
    /// Memory for the model: decoder, vertex and index arrays and their GPU copies, bytes.
    std::uint64_t memory_bytes = 16U << 20;
    std::chrono::milliseconds frame_budget{100};  ///< Time a frame may take, decoding included.
    std::uint32_t texture_limit = 512;  ///< Longest side of a texture, pixels; 0: no textures.
};

/// Returns a built-in profile (pda, phone, tablet) or reads a JSON file of the same fields:
/// `{"name", "width", "height", "memory_bytes", "frame_budget_ms", "texture_limit"}`, all but the name
/// and the limit of textures required.
/// `name_or_file`: tried as a name first. Errors: NotFound, IoError, InputTooLarge, and
/// UnsupportedInput for what is not such a file (which field and why). Safe on untrusted input.
[[nodiscard]] Result<DeviceProfile> load_device(std::string_view name_or_file);

/// Reads a device from JSON text; see load_device(). Error: UnsupportedInput.
/// Thread safe. Safe on untrusted input.
[[nodiscard]] Result<DeviceProfile> parse_device(std::string_view json);

}  // namespace vsplit::client
