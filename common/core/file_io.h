#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace vsplit {

/// Reads a whole regular file.
/// `path`: the file; `max_bytes`: refuse larger ones. Errors: NotFound, IoError, InputTooLarge.
[[nodiscard]] Result<std::vector<std::byte>> read_file(
    const std::filesystem::path& path, std::uint64_t max_bytes = std::uint64_t{1} << 33
);

/// Writes a file so that it appears under its name complete or not at all: written beside the target,
/// flushed, renamed. An existing file is replaced; a device or pipe is written to as it is. Error:
/// IoError; nothing is left behind then.
[[nodiscard]] Result<void> write_file_atomically(
    const std::filesystem::path& path, std::span<const std::byte> bytes
);

}  // namespace vsplit
