// Based on: Khronos, "glTF 2.0 Specification", 2021.
#include "precompute/corner_table.h"
#include "precompute/gltf_document.h"
#include "precompute/gltf_materials.h"
#include "precompute/gltf_nodes.h"
#include "precompute/gltf_primitive.h"
#include "precompute/group_table.h"
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::precompute {
namespace {

/// What tells one attribute of a surface from the others.
struct AttributeKey
{
    AttributeKind kind = AttributeKind::TexCoord;
    std::uint8_t set = 0;
    std::string name;

    friend auto operator<=>(const AttributeKey&, const AttributeKey&) = default;
};

std::optional<std::uint8_t> set_after(const std::string& name, std::string_view start)
{
    constexpr std::int64_t kMostSets = 8;
    const auto number =
        name.starts_with(start) ? parse_integer(name.substr(start.size())) : std::nullopt;
    const bool fits = number && *number >= 0 && *number < kMostSets;
    return fits ? std::optional(static_cast<std::uint8_t>(*number)) : std::nullopt;
}

/// What an attribute means by its name; nothing for those that have no meaning here.
std::optional<AttributeKey> key_of(const std::string& name, const AccessorValues& values)
{
    if (name == "NORMAL" && values.components == 3)
    {
        return AttributeKey{AttributeKind::Normal, 0, ""};
    }
    const auto tex_coord = set_after(name, "TEXCOORD_");
    if (tex_coord && values.components == 2)
    {
        return AttributeKey{AttributeKind::TexCoord, *tex_coord, ""};
    }
    const auto color = set_after(name, "COLOR_");
    if (color && (values.components == 3 || values.components == 4))
    {
        return AttributeKey{AttributeKind::Color, *color, ""};
    }
    const bool own = name.starts_with('_') && values.components >= 1;
    return own ? std::optional(AttributeKey{AttributeKind::Scalar, 0, name}) : std::nullopt;
}

class GltfReader
{
public:
    GltfReader(const tinygltf::Model& model, const ReadCompanion& read)
        : model_(model), images_(read, dropped_), materials_(model, images_, dropped_)
    {
    }

    Result<SourceModel> read()
    {
        VSPLIT_TRY(check_extensions());
        const auto instances = list_instances(model_, dropped_);
        if (!instances)
        {
            return tl::unexpected<Error>(instances.error());
        }
        for (const MeshInstance& instance : *instances)
        {
            VSPLIT_TRY(add_instance(instance));
        }
        return finish();
    }

private:
    Result<void> check_extensions()
    {
        // What a texture has instead of PNG and JPEG is noted where the texture is.
        static const std::set<std::string, std::less<>> kTaken{
            "KHR_draco_mesh_compression", "KHR_mesh_quantization", "KHR_texture_transform"};
        for (const std::string& name : model_.extensionsRequired)
        {
            if (name.ends_with("meshopt_compression"))
            {
                return fail(
                    ErrorCode::UnsupportedInput,
                    "the glTF file needs the extension " + name +
                        "; save it without, or compressed by Draco"
                );
            }
        }
        for (const std::string& name : model_.extensionsUsed)
        {
            if (!kTaken.contains(name))
            {
                dropped_.add("extension " + name);
            }
        }
        if (!model_.animations.empty())
        {
            dropped_.add("animations");
        }
        return {};
    }

    Result<void> add_instance(const MeshInstance& instance)
    {
        const auto known = meshes_.find(instance.mesh);
        if (known == meshes_.end())
        {
            std::vector<GltfPrimitive> primitives;
            for (const auto& source :
                 model_.meshes[static_cast<std::size_t>(instance.mesh)].primitives)
            {
                auto primitive = read_primitive(model_, source, dropped_);
                if (!primitive)
                {
                    return tl::unexpected<Error>(primitive.error());
                }
                primitives.push_back(std::move(*primitive));
            }
            meshes_.emplace(instance.mesh, std::move(primitives));
        }
        for (const GltfPrimitive& primitive : meshes_.at(instance.mesh))
        {
            VSPLIT_TRY(add_primitive(primitive, instance));
        }
        return {};
    }

    Result<void> add_primitive(const GltfPrimitive& primitive, const MeshInstance& instance)
    {
        // A few nodes may repeat a mesh until it fills any memory.
        constexpr std::size_t kMostVertices = std::size_t{1} << 26;
        const std::size_t first_vertex = builder_.vertex_count();
        const std::size_t first_triangle = builder_.triangle_count();
        if (first_vertex + primitive.positions.size() > kMostVertices ||
            first_triangle + primitive.triangles.size() > 2 * kMostVertices)
        {
            return fail(ErrorCode::InputTooLarge, "the scene has more than 67 million vertices");
        }
        for (std::size_t i = 0; i < primitive.positions.size(); ++i)
        {
            const float* const p = primitive.positions.values.data() + 3 * i;
            VSPLIT_TRY(builder_.add_vertex(move_point(instance.matrix, {p[0], p[1], p[2]})));
        }
        const bool turned = determinant(instance.matrix) < 0.0;
        for (const Triangle& triangle : primitive.triangles)
        {
            const std::array<std::int64_t, 3> corners = ordered(triangle, turned, first_vertex);
            VSPLIT_TRY(builder_.add_polygon(corners));
        }
        const std::int32_t material =
            primitive.triangles.empty() ? -1 : materials_.use(primitive.material);
        for (const auto& [name, values] : primitive.attributes)
        {
            add_attribute(name, values, primitive, instance, material, first_triangle);
        }
        groups_.assign(builder_.triangle_count(), instance.name, material);
        return {};
    }

    static std::array<std::int64_t, 3> ordered(
        const Triangle& triangle, bool turned, std::size_t first
    )
    {
        const auto start = static_cast<std::int64_t>(first);
        const auto& [a, b, c] = triangle;
        return {start + a, start + (turned ? c : b), start + (turned ? b : c)};
    }

    void add_attribute(
        const std::string& name,
        const AccessorValues& values,
        const GltfPrimitive& primitive,
        const MeshInstance& instance,
        std::int32_t material,
        std::size_t first_triangle
    )
    {
        const auto key = key_of(name, values);
        if (!key)
        {
            dropped_.add("attribute '" + name + "'");
            return;
        }
        const bool color = key->kind == AttributeKind::Color;
        const auto components = static_cast<std::uint8_t>(color ? 4 : values.components);
        const auto entry =
            tables_.try_emplace(*key, CornerTable(key->kind, components), components).first;
        auto& [table, table_components] = entry->second;
        if (components != table_components)
        {
            dropped_.add("values of '" + name + "' of another size");
            return;
        }
        const auto first = table.value_count();
        append_values(*key, values, instance, material, table);
        table.pad(first_triangle);
        const bool turned = determinant(instance.matrix) < 0.0;
        for (const Triangle& triangle : primitive.triangles)
        {
            table.add_polygon(ordered(triangle, turned, first));
        }
    }

    void append_values(
        const AttributeKey& key,
        const AccessorValues& values,
        const MeshInstance& instance,
        std::int32_t material,
        CornerTable& table
    ) const
    {
        const auto transform = key.kind == AttributeKind::TexCoord
                                   ? materials_.transform(material, key.set)
                                   : std::nullopt;
        const auto turn = normal_matrix(instance.matrix);
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            std::array<float, 4> value{0.0F, 0.0F, 0.0F, 1.0F};
            std::copy_n(
                values.values.data() + i * values.components, values.components, value.data()
            );
            if (key.kind == AttributeKind::Normal)
            {
                turn_normal(turn, value);
            }
            if (transform)
            {
                const auto& m = *transform;
                const auto [u, v] = std::array<double, 2>{value[0], value[1]};
                value[0] = to_float(m[0] * u + m[1] * v + m[2]);
                value[1] = to_float(m[3] * u + m[4] * v + m[5]);
            }
            const std::size_t size = key.kind == AttributeKind::Color ? 4 : values.components;
            table.add_value(std::span(value).first(size));
        }
    }

    /// Leaves the length 1, so that neither small nor large matrices leave single precision.
    static void turn_normal(const std::array<double, 9>& matrix, std::array<float, 4>& value)
    {
        std::array<double, 3> normal{};
        for (std::size_t row = 0; row < 3; ++row)
        {
            normal[row] =
                matrix[row] * value[0] + matrix[3 + row] * value[1] + matrix[6 + row] * value[2];
        }
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        for (std::size_t row = 0; row < 3; ++row)
        {
            value[row] = to_float(length > 0.0 ? normal[row] / length : 0.0);
        }
    }

    Result<SourceModel> finish()
    {
        if (builder_.vertex_count() == 0)
        {
            return fail(ErrorCode::EmptyMesh, "the scene of the glTF file has no triangle");
        }
        auto mesh = builder_.finish();
        if (!mesh)
        {
            return tl::unexpected<Error>(mesh.error());
        }
        SourceModel model;
        model.surface.mesh = std::move(*mesh);
        for (auto& [key, entry] : tables_)
        {
            add_finished(key, entry.first, model.surface);
        }
        groups_.finish(model);
        images_.finish(model);
        model.appearance.materials = materials_.finish();
        check_sets(model);
        tidy_attributes(model.surface, dropped_);
        model.dropped = dropped_.take();
        return model;
    }

    static void add_finished(const AttributeKey& key, CornerTable& table, Surface& surface)
    {
        if (!table.used())
        {
            return;
        }
        // finish() looks at as many numbers as a value has.
        const float missing = key.kind == AttributeKind::Color ? 1.0F : 0.0F;
        const std::array<float, 4> filler{missing, missing, missing, missing};
        std::size_t bad_corners = 0;
        surface.attributes.push_back(
            table.finish(surface.mesh.triangles.size(), filler, bad_corners)
        );
        const auto before =
            std::ranges::count(surface.attributes, key.kind, &SurfaceAttribute::kind) - 1;
        surface.attributes.back().set =
            key.kind == AttributeKind::Scalar ? static_cast<std::uint8_t>(before) : key.set;
        surface.attributes.back().name = key.name;
    }

    /// Takes off the textures that no texture coordinates place.
    void check_sets(SourceModel& model)
    {
        const auto check = [&](TextureUse& use) {
            const bool placed = std::ranges::any_of(
                model.surface.attributes,
                [&](const SurfaceAttribute& attribute) {
                    return attribute.kind == AttributeKind::TexCoord &&
                           attribute.set == use.tex_coord_set;
                }
            );
            if (use.image >= 0 && !placed)
            {
                dropped_.add("a texture on texture coordinates that are not there");
                use = {};
            }
        };
        for (Material& material : model.appearance.materials)
        {
            check(material.base_color_texture);
            check(material.metallic_roughness_texture);
            check(material.normal_texture);
            check(material.occlusion_texture);
            check(material.emissive_texture);
        }
    }

    const tinygltf::Model& model_;
    DroppedNotes dropped_;
    ImageCollector images_;
    GltfMaterials materials_;
    MeshBuilder builder_;
    GroupTable groups_;
    std::map<int, std::vector<GltfPrimitive>> meshes_;  ///< Those that were read.
    /// Attributes of the surface, and how many numbers their values have.
    std::map<AttributeKey, std::pair<CornerTable, std::uint8_t>> tables_;
};

}  // namespace

Result<SourceModel> read_gltf_model(std::span<const std::byte> bytes, const ReadCompanion& read)
{
    const auto model = parse_gltf(bytes, read);
    if (!model)
    {
        return tl::unexpected<Error>(model.error());
    }
    return GltfReader(*model, read).read();
}

}  // namespace vsplit::precompute
