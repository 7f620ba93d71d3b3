#pragma once

#include "mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vsplit::test {

/// One triangle.
[[nodiscard]] IndexedMesh triangle();

/// A tetrahedron, outwards.
[[nodiscard]] IndexedMesh tetrahedron();

/// An octahedron, outwards.
[[nodiscard]] IndexedMesh octahedron();

/// An open, wavy strip of `count` squares.
[[nodiscard]] IndexedMesh strip(std::uint32_t count);

/// A disc: `valence` triangles round a hub, the outer edges are the boundary.
[[nodiscard]] IndexedMesh fan(std::uint32_t valence);

/// A closed double cone: two hubs of `valence` triangles each.
[[nodiscard]] IndexedMesh double_cone(std::uint32_t valence);

/// A closed sphere of radius 1 with 2 * (rings - 1) * sectors triangles, its radii disturbed by up to
/// `noise`. `rings` >= 2, `sectors` >= 3.
[[nodiscard]] IndexedMesh sphere(
    std::uint32_t rings, std::uint32_t sectors, double noise, unsigned seed
);

/// A closed torus of `around` * `across` vertices, disturbed by up to `noise`; both at least 3.
[[nodiscard]] IndexedMesh torus(
    std::uint32_t around, std::uint32_t across, double noise, unsigned seed
);

/// A sheet of `width` * `height` vertices with random heights and diagonals.
[[nodiscard]] IndexedMesh height_field(
    std::uint32_t width, std::uint32_t height, double noise, unsigned seed
);

/// Two meshes as one, the second one moved by `shift` along x.
[[nodiscard]] IndexedMesh joined(const IndexedMesh& a, const IndexedMesh& b, double shift);

/// A mesh without some of its triangles, each left out with the probability `share`. The result may
/// be anything but an empty mesh.
[[nodiscard]] IndexedMesh with_holes(const IndexedMesh& mesh, double share, unsigned seed);

/// Three sheets that share one spine, a non-manifold edge path: repair cuts it. `size` >= 1 squares a
/// side.
[[nodiscard]] IndexedMesh book(std::uint32_t size);

/// The faces as sorted positions: equal for two meshes with the same faces, however they number
/// vertices and order triangles.
[[nodiscard]] std::vector<std::array<std::int32_t, 9>> face_set(const GridMesh& mesh);

}  // namespace vsplit::test
