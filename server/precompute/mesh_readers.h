#pragma once

#include "core/result.h"
#include "mesh/indexed_mesh.h"

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

/// Reads PLY: ascii and both byte orders, any scalar types, polygons and triangle strips; other
/// properties and elements are skipped.
/// `bytes`: the whole file. Result: the triangles in file order, nothing repaired.
/// Errors: NotAMesh (also when the file is cut off), BadCoordinate, BadIndex, EmptyMesh,
/// InputTooLarge. Cost: linear; every count is checked against the bytes left before it is
/// allocated for. Thread safe. Safe on untrusted input.
/// Source: Turk, "The PLY Polygon File Format", 1994.
[[nodiscard]] Result<IndexedMesh> read_ply(std::span<const std::byte> bytes);

/// Reads Object File Format: OFF, COFF, NOFF, STOFF and their combinations, one vertex or face a
/// line; normals, colours and texture coordinates are skipped.
/// Arguments, result, errors, cost as read_ply(), and UnsupportedInput for binary or
/// four-dimensional files. Thread safe. Safe on untrusted input.
/// Source: Geomview manual, "OFF Files".
[[nodiscard]] Result<IndexedMesh> read_off(std::string_view text);

/// Reads the `v` and `f` lines of Wavefront OBJ (negative indices, continued lines); all others are
/// skipped and no other file is opened.
/// Arguments, result, errors, cost as read_ply(). Thread safe. Safe on untrusted input.
/// Source: Wavefront, "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
[[nodiscard]] Result<IndexedMesh> read_obj(std::string_view text);

/// Reads ascii and binary STL; three vertices of its own for every facet.
/// Arguments, result, errors, cost as read_ply(). Thread safe. Safe on untrusted input.
/// Source: 3D Systems, "StereoLithography Interface Specification", 1989.
[[nodiscard]] Result<IndexedMesh> read_stl(std::span<const std::byte> bytes);

/// Reads OpenMesh's own format through OpenMesh: versions 1 and 2, single and double precision; normals,
/// colours, texture coordinates, status and properties are skipped, and so are faces that were deleted
/// before the file was written.
/// Arguments, result, errors, cost as read_ply(), and UnsupportedInput for later versions. Thread
/// safe; files are read one at a time. Safe on untrusted input.
/// Source: OpenMesh 9.0, OMFormat.hh.
[[nodiscard]] Result<IndexedMesh> read_om(std::span<const std::byte> bytes);

}  // namespace vsplit::precompute
