#pragma once

#include "codec/level_attributes.h"
#include "core/result.h"
#include "mesh/surface.h"
#include "precompute/encode_mesh.h"
#include "precompute/repair_surface.h"

#include <cstdint>
#include <vector>

namespace vsplit::precompute {

/// Bits of the coded numbers of attributes, 1 .. 16 each; normals at least 2.
struct AttributeBits
{
    std::uint8_t tex_coord = 10;
    std::uint8_t normal = 8;
    std::uint8_t color = 8;
    std::uint8_t scalar = 12;
};

/// The bits of a kind of attribute.
[[nodiscard]] std::uint8_t& bits_of(AttributeBits& bits, AttributeKind kind);

/// An attribute whose values are coded numbers.
struct CodedAttribute
{
    codec::AttributeInfo info;
    std::vector<std::int32_t>
        values;                     ///< codec::coded_components() numbers a value, all different.
    std::vector<Triangle> corners;  ///< By triangle the values at its corners.
};

/// Rounds the values of an attribute to the numbers that are coded; equal ones become one.
/// `attribute`: all values finite, corners in range. Error: UnsupportedInput (components that no attribute
/// of the kind has). Cost: one sort. Deterministic. Thread safe.
/// Source of the colours' numbers: Malvar, Sullivan, "YCoCg-R", 2003.
[[nodiscard]] Result<CodedAttribute> code_attribute(
    const SurfaceAttribute& attribute, const AttributeBits& bits
);

/// Turns a repaired surface into what encode_surface() takes.
/// Errors: as code_attribute(). Cost: linear but for a sort of every attribute. Deterministic. Thread safe.
[[nodiscard]] Result<EncodeInput> make_encode_input(
    RepairedSurface&& surface, const AttributeBits& bits
);

}  // namespace vsplit::precompute
