#pragma once

#include "core/result.h"
#include "precompute/image_collector.h"

#include <cstddef>
#include <span>
#include <tiny_gltf.h>

namespace vsplit::precompute {

/// Parses a GLB or glTF file as far as tinygltf does; its images stay as they are. Nothing that the
/// document says about its own bytes has been checked: read them with gltf_accessor.h and view_bytes().
/// `bytes`: the whole file; `read`: gives external buffers and images, or empty: there are none.
/// Errors: NotAMesh (what tinygltf says), InputTooLarge (4 GiB and more, or JSON nested deeply).
/// Thread safe. Safe on untrusted input as far as tinygltf is.
/// Source: Khronos, "glTF 2.0 Specification", 2021.
[[nodiscard]] Result<tinygltf::Model> parse_gltf(
    std::span<const std::byte> bytes, const ReadCompanion& read
);

/// The bytes of a buffer view. Error: NotAMesh when it does not exist or leaves its buffer. Safe on
/// untrusted input.
[[nodiscard]] Result<std::span<const std::byte>> view_bytes(const tinygltf::Model& model, int view);

}  // namespace vsplit::precompute
