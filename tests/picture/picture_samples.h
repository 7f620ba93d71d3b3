#pragma once

#include "mesh/surface.h"

#include <cstdint>

namespace vsplit::test {

/// A square in the plane z = 0 from -1 to 1, of `cells` * `cells` squares, with texture coordinates 0 .. 1
/// from its upper left corner.
[[nodiscard]] Surface textured_square(std::uint32_t cells);

/// A sphere of radius 1 that was cut along a meridian: the vertices there exist twice, and the second
/// copies lie `gap` radians before them. `hole`: latitude, radians, above which it is open around the
/// pole; 2 for none.
[[nodiscard]] Surface cut_sphere(
    std::uint32_t rings, std::uint32_t sectors, double gap, double hole = 2.0
);

}  // namespace vsplit::test
