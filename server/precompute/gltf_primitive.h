#pragma once

#include "core/result.h"
#include "precompute/gltf_accessor.h"
#include "precompute/source_model.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace vsplit::precompute {

/// A part of a mesh as its file has it: everything by vertex.
struct GltfPrimitive
{
    std::map<std::string, AccessorValues>
        attributes;                   ///< By glTF's names; POSITION is not among them.
    AccessorValues positions;         ///< Three numbers a vertex.
    std::vector<Triangle> triangles;  ///< Indices in range.
    int material = -1;
};

/// Reads one primitive: triangles, strips and fans, with or without indices, compressed by Draco or not.
/// `dropped`: gets notes for points, lines, morph targets, tangents, joints and weights, and for
/// attributes that do not fit. Result: no triangle at all for points and lines.
/// Errors: NotAMesh, BadIndex, InputTooLarge. Cost: linear. Safe on untrusted input.
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.7.2.
[[nodiscard]] Result<GltfPrimitive> read_primitive(
    const tinygltf::Model& model, const tinygltf::Primitive& primitive, DroppedNotes& dropped
);

/// Decodes a primitive that Draco compressed; its counts are compared with the bytes before Draco sees
/// them. `extension`: the object KHR_draco_mesh_compression. Result: attributes by name, and triangles.
/// Errors: NotAMesh. Safe on untrusted input as far as Draco is.
/// Source: Khronos, "KHR_draco_mesh_compression", 2018.
[[nodiscard]] Result<GltfPrimitive> decode_draco_primitive(
    const tinygltf::Model& model,
    const tinygltf::Primitive& primitive,
    const tinygltf::Value& extension,
    DroppedNotes& dropped
);

}  // namespace vsplit::precompute
