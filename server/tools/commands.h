#pragma once

#include "core/result.h"

#include <CLI/App.hpp>

namespace vsplit::tools {

/// Adds `vsplit encode` to `app`; when the command line names it, parsing runs it and sets `result`.
/// Both must live until then. Throws what CLI11 throws on a wrong command line.
void add_encode_command(CLI::App& app, Result<void>& result);

/// Adds `vsplit inspect`; otherwise as add_encode_command().
void add_inspect_command(CLI::App& app, Result<void>& result);

/// Adds `vsplit decode`; otherwise as add_encode_command().
void add_decode_command(CLI::App& app, Result<void>& result);

/// Adds `vsplit verify`; otherwise as add_encode_command().
void add_verify_command(CLI::App& app, Result<void>& result);

}  // namespace vsplit::tools
