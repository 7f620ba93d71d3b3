#pragma once

#include "mesh/surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::precompute {

/// Rounds to single precision; numbers beyond it become infinite, which tidy_attributes() finds.
[[nodiscard]] float to_float(double value);

/// Collects the values of an attribute and which of them the corners of polygons have, triangle by
/// triangle as MeshBuilder makes them. Not thread safe. Safe on untrusted input.
class CornerTable
{
public:
    /// Starts an empty table of values of `components` numbers, 1 .. 4.
    CornerTable(AttributeKind kind, std::uint8_t components);

    /// Appends a value. `value`: as many numbers as the table has components. Result: its index.
    std::int64_t add_value(std::span<const float> value);

    /// Number of values.
    [[nodiscard]] std::size_t value_count() const { return attribute_.size(); }

    /// Triangles so far.
    [[nodiscard]] std::size_t triangle_count() const { return attribute_.corners.size(); }

    /// Appends the triangles that MeshBuilder::add_polygon() makes. `values`: for each corner the
    /// index of its value, which may come later; negative for none.
    void add_polygon(std::span<const std::int64_t> values);

    /// Appends triangles without values until there are `triangles`.
    void pad(std::size_t triangles);

    /// True when a corner has a value.
    [[nodiscard]] bool used() const { return used_; }

    /// Takes the attribute, for a mesh of `triangles`. Corners without a value, or with one that never
    /// came, get `missing` (at least as many numbers as components). Result: how many corners had one that never
    /// came, in `bad_corners`.
    [[nodiscard]] SurfaceAttribute finish(
        std::size_t triangles, std::span<const float> missing, std::size_t& bad_corners
    );

private:
    SurfaceAttribute attribute_;
    bool used_ = false;
};

}  // namespace vsplit::precompute
