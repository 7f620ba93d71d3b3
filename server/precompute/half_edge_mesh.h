#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <cstdint>

namespace vsplit::precompute {

/// The half-edge mesh that the precompute walks on: OpenMesh's, with positions in double precision and
/// no other attribute. Circulators on a const mesh are thread safe.
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// Returns the handle of the vertex of that number.
[[nodiscard]] inline OpenMesh::VertexHandle vertex_handle(std::uint32_t vertex)
{
    return OpenMesh::VertexHandle(static_cast<int>(vertex));
}

/// Links the triangles of a 2-manifold with boundary, such as repair_mesh() makes.
/// `mesh`: any mesh; positions do not matter. Result: vertex and face i are those of `mesh`, and the
/// vertices of a face come in its order, from its first.
/// Errors: those of check_manifold(), which is to say that it succeeds for manifolds and for nothing
/// else; InputTooLarge beyond 2^30 / 3 triangles, which OpenMesh's handles cannot number.
/// Cost: linear plus one sort within each vertex, about 0.4 microseconds and 140 bytes a vertex.
/// Deterministic. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<HalfEdgeMesh> make_half_edge_mesh(const IndexedMesh& mesh);

/// Returns the number of connected components. Cost: linear. Thread safe.
[[nodiscard]] std::uint32_t component_count(const HalfEdgeMesh& mesh);

/// Returns the number of edges that have one face. Cost: linear. Thread safe.
[[nodiscard]] std::uint32_t boundary_edge_count(const HalfEdgeMesh& mesh);

}  // namespace vsplit::precompute
