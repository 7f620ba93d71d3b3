#pragma once

#include "core/result.h"
#include "precompute/source_model.h"

#include <array>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace vsplit::precompute {

/// A 4x4 matrix, column after column, as glTF has it.
using Matrix = std::array<double, 16>;

/// A mesh where a scene has it.
struct MeshInstance
{
    int mesh = 0;  ///< Index in range.
    Matrix matrix{};
    std::string name;  ///< Of the mesh, or of its node.
};

/// Walks over the default scene (the first one; without scenes, all nodes that are no one's child) and
/// lists its meshes with their transformations multiplied out.
/// `dropped`: gets notes for cameras, skins, lights and other scenes. Errors: NotAMesh (a node that does
/// not exist, has two parents or is its own ancestor). Cost: linear. Safe on untrusted input.
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.5.
[[nodiscard]] Result<std::vector<MeshInstance>> list_instances(
    const tinygltf::Model& model, DroppedNotes& dropped
);

/// Moves a point.
[[nodiscard]] std::array<double, 3> move_point(
    const Matrix& matrix, const std::array<double, 3>& point
);

/// Matrix that moves normals: the cofactors of the upper left 3x3 part, column after column, with the sign
/// of its determinant (Khronos, section 3.7.2.1: the inverse transpose, but for its length).
[[nodiscard]] std::array<double, 9> normal_matrix(const Matrix& matrix);

/// Determinant of the upper left 3x3 part; negative: the triangles turn over.
[[nodiscard]] double determinant(const Matrix& matrix);

}  // namespace vsplit::precompute
