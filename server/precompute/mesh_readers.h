#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"
#include "precompute/image_collector.h"
#include "precompute/source_model.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace vsplit::precompute {

// What OpenMesh reads: its own format, behind checks of everything that it would believe. The others
// have readers of our own, because OpenMesh 9.0 rounds every coordinate to float, drops degenerate
// facets silently (the repair report would be untrue), loses its place in PLY list properties, gives
// no triangles for strips, reads no comment in OFF, allocates for any count that a face claims, and
// opens the files that an OBJ names. Its binary OFF is no other program's: little-endian and without
// the colour counts of the Geomview manual; as nothing in a file tells them apart, both are refused.
// The tests compare these readers with OpenMesh's.

/// Reads PLY: ascii and both byte orders, any scalar types, polygons and triangle strips, with what lies
/// on the vertices (plan_ply_vertices() says which properties), texture coordinates of faces' corners and
/// the image that a comment names; other properties and elements are skipped.
/// `bytes`: the whole file; `read`: gives the image, or
/// empty: no other file is opened. Result: the triangles in file order, nothing
/// repaired. Errors: NotAMesh (also when the file is cut off), BadCoordinate, BadIndex, EmptyMesh,
/// InputTooLarge. Cost: linear; every count is checked against the bytes left before it is
/// allocated for. Thread safe. Safe on untrusted input.
/// Source: Turk, "The PLY Polygon File Format", 1994.
[[nodiscard]] Result<SourceModel> read_ply_model(
    std::span<const std::byte> bytes, const ReadCompanion& read
);

/// Reads Object File Format: OFF, COFF, NOFF, STOFF and their combinations, one vertex or face a
/// line; normals, colours and texture coordinates are skipped.
/// Arguments, result, errors, cost as read_ply_model(), and UnsupportedInput for binary or
/// four-dimensional files. Thread safe. Safe on untrusted input.
/// Source: Geomview manual, "OFF Files".
[[nodiscard]] Result<IndexedMesh> read_off(std::string_view text);

/// Reads Wavefront OBJ (negative indices, continued lines): polygons, texture coordinates, normals,
/// colours behind the coordinates of vertices, groups, objects and materials; other lines are noted or
/// skipped. Texture coordinates are turned so that v points downwards.
/// `text`: the whole file; `read`: gives the material libraries and images, or empty: no
/// other file is opened. Result, errors, cost as
/// read_ply_model(); attributes that are wrong are noted, not errors. Thread safe. Safe on untrusted input.
/// Source: Wavefront, "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
[[nodiscard]] Result<SourceModel> read_obj_model(std::string_view text, const ReadCompanion& read);

/// Reads GLB and glTF 2.0: the meshes of the default scene where their nodes put them, compressed by Draco
/// or not, with normals, texture coordinates, colours, values of names that start with "_", materials and
/// images. Every mesh and material is a group. Skins, animations, morph targets, cameras, lights and
/// other extensions are noted.
/// `bytes`: the whole file; `read`: gives external buffers and images, or empty: no other file is opened.
/// Result, errors, cost as read_ply_model(), and UnsupportedInput for compressions of other extensions.
/// Thread safe. Safe on untrusted input as far as tinygltf and Draco are; all counts are ours to check.
/// Source: Khronos, "glTF 2.0 Specification", 2021.
[[nodiscard]] Result<SourceModel> read_gltf_model(
    std::span<const std::byte> bytes, const ReadCompanion& read
);

/// Reads ascii and binary STL; three vertices of its own for every facet.
/// Arguments, result, errors, cost as read_ply_model(). Thread safe. Safe on untrusted input.
/// Source: 3D Systems, "StereoLithography Interface Specification", 1989.
[[nodiscard]] Result<IndexedMesh> read_stl(std::span<const std::byte> bytes);

/// Reads OpenMesh's own format through OpenMesh: versions 1 and 2, single and double precision; normals,
/// colours, texture coordinates, status and properties are skipped, and so are faces that were deleted
/// before the file was written.
/// Arguments, result, errors, cost as read_ply_model(), and UnsupportedInput for later versions. Thread
/// safe; files are read one at a time. Safe on untrusted input.
/// Source: OpenMesh 9.0, OMFormat.hh.
[[nodiscard]] Result<IndexedMesh> read_om(std::span<const std::byte> bytes);

}  // namespace vsplit::precompute
