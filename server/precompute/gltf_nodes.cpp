// Based on: Khronos, "glTF 2.0 Specification", 2021, sections 3.5 (scenes, nodes, transformations) and
// 3.7.4 (winding order of instances).
#include "precompute/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix multiply(const Matrix& a, const Matrix& b)
{
    Matrix product{};
    for (std::size_t column = 0; column < 4; ++column)
    {
        for (std::size_t row = 0; row < 4; ++row)
        {
            double sum = 0.0;
            for (std::size_t i = 0; i < 4; ++i)
            {
                sum += a[4 * i + row] * b[4 * column + i];
            }
            product[4 * column + row] = sum;
        }
    }
    return product;
}

/// T R S; section 3.5.2.
Matrix local_matrix(const tinygltf::Node& node)
{
    if (node.matrix.size() == 16)
    {
        Matrix matrix{};
        std::copy(node.matrix.begin(), node.matrix.end(), matrix.begin());
        return matrix;
    }
    std::array<double, 4> q{0.0, 0.0, 0.0, 1.0};
    std::array<double, 3> s{1.0, 1.0, 1.0};
    std::array<double, 3> t{};
    std::copy_n(node.rotation.begin(), node.rotation.size() == 4 ? 4 : 0, q.begin());
    std::copy_n(node.scale.begin(), node.scale.size() == 3 ? 3 : 0, s.begin());
    std::copy_n(node.translation.begin(), node.translation.size() == 3 ? 3 : 0, t.begin());
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& component : q)
    {
        component = length > 0.0 ? component / length : 0.0;
    }
    const auto [x, y, z, w] = q;
    return {
        (1 - 2 * (y * y + z * z)) * s[0],
        2 * (x * y + w * z) * s[0],
        2 * (x * z - w * y) * s[0],
        0,
        2 * (x * y - w * z) * s[1],
        (1 - 2 * (x * x + z * z)) * s[1],
        2 * (y * z + w * x) * s[1],
        0,
        2 * (x * z + w * y) * s[2],
        2 * (y * z - w * x) * s[2],
        (1 - 2 * (x * x + y * y)) * s[2],
        0,
        t[0],
        t[1],
        t[2],
        1};
}

class SceneWalk
{
public:
    SceneWalk(const tinygltf::Model& model, DroppedNotes& dropped)
        : model_(model), dropped_(dropped), seen_(model.nodes.size(), 0)
    {
    }

    Result<std::vector<MeshInstance>> run(const std::vector<int>& roots)
    {
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
        {
            waiting_.emplace_back(*root, kIdentity);
        }
        while (!waiting_.empty())
        {
            const auto [index, parent] = waiting_.back();
            waiting_.pop_back();
            if (index < 0 || static_cast<std::size_t>(index) >= seen_.size() ||
                std::exchange(seen_[static_cast<std::size_t>(index)], 1) != 0)
            {
                return fail(
                    ErrorCode::NotAMesh,
                    "the nodes of the glTF file are no tree: node " + std::to_string(index)
                );
            }
            visit(model_.nodes[static_cast<std::size_t>(index)], parent);
        }
        return std::move(instances_);
    }

private:
    void visit(const tinygltf::Node& node, const Matrix& parent)
    {
        const Matrix matrix = multiply(parent, local_matrix(node));
        if (node.camera >= 0)
        {
            dropped_.add("cameras");
        }
        if (node.skin >= 0)
        {
            dropped_.add("skins (the mesh stands as it was bound)");
        }
        for (const auto& [name, value] : node.extensions)
        {
            dropped_.add("extension " + name + " of a node");
        }
        if (node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model_.meshes.size())
        {
            const std::string& name = model_.meshes[static_cast<std::size_t>(node.mesh)].name;
            instances_.push_back({node.mesh, matrix, name.empty() ? node.name : name});
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        {
            waiting_.emplace_back(*child, matrix);
        }
    }

    const tinygltf::Model& model_;
    DroppedNotes& dropped_;
    std::vector<std::uint8_t> seen_;
    std::vector<std::pair<int, Matrix>> waiting_;
    std::vector<MeshInstance> instances_;
};

/// Nodes that are no one's child.
std::vector<int> root_nodes(const tinygltf::Model& model)
{
    std::vector<std::uint8_t> is_child(model.nodes.size(), 0);
    for (const tinygltf::Node& node : model.nodes)
    {
        for (const int child : node.children)
        {
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
            {
                is_child[static_cast<std::size_t>(child)] = 1;
            }
        }
    }
    std::vector<int> roots;
    for (std::size_t node = 0; node < is_child.size(); ++node)
    {
        if (is_child[node] == 0)
        {
            roots.push_back(static_cast<int>(node));
        }
    }
    return roots;
}

}  // namespace

Result<std::vector<MeshInstance>> list_instances(
    const tinygltf::Model& model, DroppedNotes& dropped
)
{
    if (model.scenes.size() > 1)
    {
        dropped.add("all scenes but the default one");
    }
    if (model.nodes.empty())
    {
        std::vector<MeshInstance> instances;
        for (std::size_t mesh = 0; mesh < model.meshes.size(); ++mesh)
        {
            instances.push_back({static_cast<int>(mesh), kIdentity, model.meshes[mesh].name});
        }
        return instances;
    }
    if (model.scenes.empty())
    {
        return SceneWalk(model, dropped).run(root_nodes(model));
    }
    const auto given = static_cast<std::size_t>(std::max(model.defaultScene, 0));
    const std::size_t scene = given < model.scenes.size() ? given : 0;
    return SceneWalk(model, dropped).run(model.scenes[scene].nodes);
}

std::array<double, 3> move_point(const Matrix& matrix, const std::array<double, 3>& point)
{
    std::array<double, 3> moved{};
    for (std::size_t row = 0; row < 3; ++row)
    {
        moved[row] = matrix[row] * point[0] + matrix[4 + row] * point[1] +
                     matrix[8 + row] * point[2] + matrix[12 + row];
    }
    return moved;
}

std::array<double, 9> normal_matrix(const Matrix& m)
{
    const double sign = determinant(m) < 0.0 ? -1.0 : 1.0;
    std::array<double, 9> result{
        m[5] * m[10] - m[6] * m[9],
        m[6] * m[8] - m[4] * m[10],
        m[4] * m[9] - m[5] * m[8],
        m[9] * m[2] - m[10] * m[1],
        m[10] * m[0] - m[8] * m[2],
        m[8] * m[1] - m[9] * m[0],
        m[1] * m[6] - m[2] * m[5],
        m[2] * m[4] - m[0] * m[6],
        m[0] * m[5] - m[1] * m[4]};
    for (double& entry : result)
    {
        entry *= sign;
    }
    return result;
}

double determinant(const Matrix& m)
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) + m[4] * (m[9] * m[2] - m[10] * m[1]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

}  // namespace vsplit::precompute
