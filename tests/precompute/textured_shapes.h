#pragma once

#include "mesh/indexed_mesh.h"
#include "precompute/wedges.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vsplit::test {

/// A mesh with charts and slits.
struct TexturedShape
{
    std::string name;
    IndexedMesh mesh;
    std::vector<std::uint32_t> groups;  ///< By triangle.
    precompute::Wedges wedges;
};

/// Divides the faces of a mesh into `charts` connected regions that grow from random faces, and splits
/// the values round a share of the vertices at random, which makes slits. `mesh` is repaired first.
[[nodiscard]] TexturedShape textured(
    const std::string& name,
    const IndexedMesh& mesh,
    std::uint32_t charts,
    double slits,
    unsigned seed
);

/// Closed and open shapes, with few and many charts, with and without slits.
[[nodiscard]] std::vector<TexturedShape> textured_shapes();

}  // namespace vsplit::test
