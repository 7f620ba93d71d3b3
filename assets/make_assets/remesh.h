#pragma once

#include "make_assets/polygonise.h"
#include "make_assets/vector3.h"
#include "mesh/indexed_mesh.h"

#include <functional>

namespace vsplit::assets {

/// The smooth surface that a mesh approximates.
struct TargetSurface
{
    std::function<Vector3(const Vector3&)> project;  ///< The surface point near a point.
    std::function<Vector3(const Vector3&)> normal;   ///< Unit normal at a surface point.
};

/// How fine a mesh should be.
struct RemeshOptions
{
    double chord_error = 0.001;    ///< Distance of an edge's middle from the surface, model units.
    double shortest_edge = 0.005;  ///< Model units, > 0.
    double longest_edge = 0.1;     ///< Model units, > shortest_edge.
    int rounds = 6;
};

/// Describes the zero set of a field. `step`: difference step for gradients, model units.
[[nodiscard]] TargetSurface surface_of(const Field& field, double step);

/// Re-triangulates a mesh over its surface so that edges are as long as curvature allows: short where
/// it bends, long where it is flat, nearly equilateral everywhere. Boundaries stay as they are.
/// `mesh`: a 2-manifold near `surface`. Result: a 2-manifold of the same topology.
/// Cost: about 20 projections a vertex. Deterministic.
/// Source: Botsch, Kobbelt, "A Remeshing Approach to Multiresolution Modeling", 2004; edge lengths
/// from curvature: Dunyach, Vanderhaeghe, Barthe, Botsch, "Adaptive Remeshing for Real-Time Mesh
/// Deformation", 2013.
[[nodiscard]] IndexedMesh remesh(
    const IndexedMesh& mesh, const TargetSurface& surface, const RemeshOptions& options
);

}  // namespace vsplit::assets
