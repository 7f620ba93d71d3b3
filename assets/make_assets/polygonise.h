#pragma once

#include "make_assets/vector3.h"
#include "mesh/indexed_mesh.h"

#include <functional>

namespace vsplit::assets {

/// A scalar field: negative inside a body, positive outside, about a distance: it grows by at most
/// kSteepest a unit of length, so that far from the surface lattice points can be skipped.
using Field = std::function<double(const Vector3&)>;

/// Largest gradient of a Field.
inline constexpr double kSteepest = 3.0;

/// An axis-aligned box of cubic cells.
struct Lattice
{
    Vector3 low;
    Vector3 high;
    double cell = 0.1;  ///< Edge of a cell, > 0.
};

/// Polygonises the zero set of a field with marching tetrahedra.
/// Precondition: the body lies inside the lattice. Result: a closed 2-manifold, counter-clockwise seen
/// from outside; its triangles are as uneven as those of every lattice method. Cost: about one evaluation
/// a lattice point near the surface.
/// Source: Doi, Koide, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using
/// Tetrahedral Cells", 1991.
[[nodiscard]] IndexedMesh polygonise(const Field& field, const Lattice& lattice);

}  // namespace vsplit::assets
