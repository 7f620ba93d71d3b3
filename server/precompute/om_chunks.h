#pragma once

#include "core/result.h"

#include <cstddef>
#include <span>
#include <string>

namespace vsplit::precompute {

/// Reduces a file in OpenMesh's own format to positions and topology. OpenMesh's reader believes every
/// length, aborts or throws at shapes that it does not expect and makes whatever properties a file
/// names; with this it has nothing left to trip over but handles out of range, which its importer sees.
/// `file`: the whole file. Result: a file of the same version whose chunks are all there.
/// Errors: NotAMesh (also when the file is cut off), UnsupportedInput (a later version),
/// InputTooLarge. Cost: linear. Thread safe. Safe on untrusted input.
/// Source: OpenMesh 9.0, OMFormat.hh.
[[nodiscard]] Result<std::string> om_geometry(std::span<const std::byte> file);

}  // namespace vsplit::precompute
