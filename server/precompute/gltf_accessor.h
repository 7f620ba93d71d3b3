#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <tiny_gltf.h>
#include <vector>

namespace vsplit::precompute {

/// The elements of an accessor.
struct AccessorValues
{
    std::size_t components = 0;  ///< Numbers in an element, 1 .. 4.
    std::vector<float> values;

    /// Number of elements.
    [[nodiscard]] std::size_t size() const
    {
        return components == 0 ? 0 : values.size() / components;
    }
};

/// Reads scalars or vectors of any component type; normalised integers become 0 .. 1 or -1 .. 1.
/// `accessor`: its index. Errors: NotAMesh when it, its buffer view or its sparse values do not exist or
/// leave their bytes, or when it holds matrices. Every count is compared with the bytes there are
/// before anything is allocated. Cost: linear. Thread safe. Safe on untrusted input.
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.6.2.
[[nodiscard]] Result<AccessorValues> read_values(const tinygltf::Model& model, int accessor);

/// Reads unsigned scalars exactly. Everything else as read_values().
[[nodiscard]] Result<std::vector<std::uint32_t>> read_indices(
    const tinygltf::Model& model, int accessor
);

}  // namespace vsplit::precompute
