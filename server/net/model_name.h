#pragma once

#include "core/result.h"

#include <filesystem>
#include <string_view>

namespace vsplit::net {

/// Where a model is and what must be done to serve it.
struct ModelLocation
{
    std::filesystem::path path;   ///< Absolute, canonical, below the root, a regular file.
    bool is_source_mesh = false;  ///< True when it must be encoded first.
};

/// Says whether a name obeys the rules of the protocol: relative, no empty, "." or ".." part, no
/// backslash, no control character. Thread safe. Safe on untrusted input.
/// Source: proto/WIRE_PROTOCOL.md, "Names".
[[nodiscard]] bool is_valid_model_name(std::string_view name);

/// Finds the file that a model name stands for.
/// `root`: absolute, canonical folder; `name`: as received from a client.
/// Error: NotFound, with the same message whether the file is missing, of another kind or outside the
/// root. Cost: a few file-system look-ups. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<ModelLocation> locate_model(
    const std::filesystem::path& root, std::string_view name
);

}  // namespace vsplit::net
