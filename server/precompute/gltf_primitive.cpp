// Based on: Khronos, "glTF 2.0 Specification", 2021, section 3.7.2 (which triangles a primitive has).
#include "precompute/gltf_primitive.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr const char* kDracoName = "KHR_draco_mesh_compression";

/// The triangles that a list of vertices makes; section 3.7.2.1.
std::vector<Triangle> assemble(int mode, const std::vector<std::uint32_t>& list)
{
    std::vector<Triangle> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES)
    {
        triangles.reserve(list.size() / 3);
        for (std::size_t i = 0; i + 2 < list.size(); i += 3)
        {
            triangles.push_back({list[i], list[i + 1], list[i + 2]});
        }
        return triangles;
    }
    for (std::size_t i = 0; i + 2 < list.size(); ++i)
    {
        const bool strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
        const std::size_t odd = i % 2;
        const Triangle triangle = strip ? Triangle{list[i], list[i + 1 + odd], list[i + 2 - odd]}
                                        : Triangle{list[i + 1], list[i + 2], list[0]};
        const auto& [a, b, c] = triangle;
        if (a != b && b != c && c != a)  // the others only join strips
        {
            triangles.push_back(triangle);
        }
    }
    return triangles;
}

/// True for what has no place in a surface, after a note.
bool is_left_out(const std::string& name, DroppedNotes& dropped)
{
    if (name == "TANGENT")
    {
        dropped.add("tangents (derived again for drawing)");
        return true;
    }
    const bool skinned = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
    if (skinned)
    {
        dropped.add("joints and weights of a skin");
    }
    return skinned;
}

Result<void> read_attributes(
    const tinygltf::Model& model,
    const tinygltf::Primitive& primitive,
    GltfPrimitive& result,
    DroppedNotes& dropped
)
{
    for (const auto& [name, accessor] : primitive.attributes)
    {
        if (is_left_out(name, dropped))
        {
            continue;
        }
        auto values = read_values(model, accessor);
        if (!values)
        {
            return tl::unexpected<Error>(values.error());
        }
        if (name == "POSITION")
        {
            result.positions = std::move(*values);
        }
        else
        {
            result.attributes.emplace(name, std::move(*values));
        }
    }
    return {};
}

Result<GltfPrimitive> read_plain(
    const tinygltf::Model& model, const tinygltf::Primitive& primitive, DroppedNotes& dropped
)
{
    GltfPrimitive result;
    VSPLIT_TRY(read_attributes(model, primitive, result, dropped));
    std::vector<std::uint32_t> list(primitive.indices < 0 ? result.positions.size() : 0);
    std::iota(list.begin(), list.end(), std::uint32_t{0});
    if (primitive.indices >= 0)
    {
        auto indices = read_indices(model, primitive.indices);
        if (!indices)
        {
            return tl::unexpected<Error>(indices.error());
        }
        list = std::move(*indices);
    }
    result.triangles = assemble(primitive.mode, list);
    return result;
}

/// Checks what both ways of reading may get wrong.
Result<void> check(GltfPrimitive& primitive, DroppedNotes& dropped)
{
    if (primitive.positions.components != 3)
    {
        return fail(ErrorCode::NotAMesh, "a mesh of the glTF file has no positions");
    }
    const std::size_t vertices = primitive.positions.size();
    const bool in_range = std::ranges::all_of(primitive.triangles, [&](const Triangle& triangle) {
        return std::ranges::max(triangle) < vertices;
    });
    if (!in_range)
    {
        return fail(ErrorCode::BadIndex, "a triangle of the glTF file has a vertex too many");
    }
    std::erase_if(primitive.attributes, [&](const auto& entry) {
        const bool fits = entry.second.size() == vertices;
        if (!fits)
        {
            dropped.add("attribute '" + entry.first + "', which does not fit the vertices");
        }
        return !fits;
    });
    return {};
}

}  // namespace

Result<GltfPrimitive> read_primitive(
    const tinygltf::Model& model, const tinygltf::Primitive& primitive, DroppedNotes& dropped
)
{
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    {
        dropped.add("points and lines");
        return GltfPrimitive{};
    }
    if (!primitive.targets.empty())
    {
        dropped.add("morph targets");
    }
    const auto draco = primitive.extensions.find(kDracoName);
    auto result = draco == primitive.extensions.end()
                      ? read_plain(model, primitive, dropped)
                      : decode_draco_primitive(model, primitive, draco->second, dropped);
    if (!result)
    {
        return result;
    }
    VSPLIT_TRY(check(*result, dropped));
    result->material = primitive.material;
    return result;
}

}  // namespace vsplit::precompute
