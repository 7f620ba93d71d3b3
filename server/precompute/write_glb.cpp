// Based on: Khronos, "glTF 2.0 Specification", 2021.
#include "precompute/glb_materials.h"
#include "precompute/model_writers.h"
#include "precompute/wedge_mesh.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace vsplit::precompute {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

const char* type_name(std::size_t components)
{
    constexpr std::array<const char*, 4> kNames{"SCALAR", "VEC2", "VEC3", "VEC4"};
    return kNames[components - 1];
}

class GlbWriter
{
public:
    explicit GlbWriter(const ModelView& model) : model_(model), materials_(model, tex_coord_sets_)
    {
        name_attributes();
    }

    Result<WrittenFiles> write()
    {
        if (model_.mesh.triangles.empty())
        {
            return fail(ErrorCode::EmptyMesh, "there is no triangle, and glTF knows no empty mesh");
        }
        document_["asset"] = {{"version", "2.0"}, {"generator", "vsplit"}};
        write_meshes();
        materials_.add_to(document_);
        write_images();
        document_["scene"] = 0;
        document_["buffers"] = {{{"byteLength", buffer_.size()}}};
        return assemble();
    }

private:
    /// glTF numbers the sets of a kind from 0 without gaps.
    void name_attributes()
    {
        std::vector<const SurfaceAttribute*> sorted;
        for (const SurfaceAttribute& attribute : model_.attributes)
        {
            sorted.push_back(&attribute);
        }
        std::ranges::stable_sort(sorted, {}, &SurfaceAttribute::set);
        std::map<AttributeKind, int> next;
        for (const SurfaceAttribute* const attribute : sorted)
        {
            const int number = next[attribute->kind]++;
            std::string name = name_of(*attribute, number);
            if (!name.empty())
            {
                attributes_.push_back(attribute);
                names_.push_back(std::move(name));
            }
        }
    }

    std::string name_of(const SurfaceAttribute& attribute, int number)
    {
        switch (attribute.kind)
        {
            case AttributeKind::TexCoord:
                tex_coord_sets_.emplace(attribute.set, number);
                return "TEXCOORD_" + std::to_string(number);
            case AttributeKind::Normal:
                return number == 0 ? "NORMAL" : "";
            case AttributeKind::Color:
                return "COLOR_" + std::to_string(number);
            case AttributeKind::Scalar:
                break;
        }
        const std::string name =
            attribute.name.empty() ? "SCALAR_" + std::to_string(number) : attribute.name;
        return name.starts_with('_') ? name : "_" + name;
    }

    /// The triangles of every group that has some.
    [[nodiscard]] std::map<std::uint32_t, std::vector<std::uint32_t>> faces_by_group() const
    {
        std::map<std::uint32_t, std::vector<std::uint32_t>> faces;
        for (std::uint32_t face = 0; face < model_.mesh.triangles.size(); ++face)
        {
            faces[model_.groups.empty() ? 0 : model_.groups[face]].push_back(face);
        }
        return faces;
    }

    void write_meshes()
    {
        std::map<std::string, std::size_t> mesh_by_name;
        for (const auto& [group, faces] : faces_by_group())
        {
            const bool known =
                model_.appearance != nullptr && group < model_.appearance->groups.size();
            const FaceGroup row = known ? model_.appearance->groups[group] : FaceGroup{};
            const auto [entry, is_new] = mesh_by_name.try_emplace(row.name, mesh_by_name.size());
            if (is_new)
            {
                add_mesh(row.name, entry->second);
            }
            json primitive = write_primitive(faces);
            if (row.material >= 0)
            {
                primitive["material"] = row.material;
            }
            document_["meshes"][entry->second]["primitives"].push_back(std::move(primitive));
        }
    }

    void add_mesh(const std::string& name, std::size_t index)
    {
        json mesh{{"primitives", json::array()}};
        json node{{"mesh", index}};
        if (!name.empty())
        {
            mesh["name"] = name;
            node["name"] = name;
        }
        document_["meshes"].push_back(std::move(mesh));
        document_["nodes"].push_back(std::move(node));
        document_["scenes"][0]["nodes"].push_back(index);
    }

    json write_primitive(const std::vector<std::uint32_t>& faces)
    {
        const WedgeMesh wedges =
            split_wedges(model_.mesh.triangles, attributes_, faces, model_.mesh.positions.size());
        json attributes{{"POSITION", write_positions(wedges)}};
        for (std::size_t i = 0; i < attributes_.size(); ++i)
        {
            attributes[names_[i]] = write_attribute(wedges, i);
        }
        return {{"attributes", std::move(attributes)}, {"indices", write_indices(wedges)}};
    }

    std::size_t write_positions(const WedgeMesh& wedges)
    {
        std::array<float, 3> low{};
        std::array<float, 3> high{};
        low.fill(std::numeric_limits<float>::max());
        high.fill(std::numeric_limits<float>::lowest());
        const std::size_t start = buffer_.size();
        for (const std::uint32_t vertex : wedges.vertices)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const auto value = static_cast<float>(model_.mesh.positions[vertex][axis]);
                low[axis] = std::min(low[axis], value);
                high[axis] = std::max(high[axis], value);
                append_float(buffer_, value);
            }
        }
        json accessor = float_accessor(wedges.vertices.size(), 3);
        accessor["min"] = low;
        accessor["max"] = high;
        return add_accessor(std::move(accessor), start, kArrayBuffer);
    }

    std::size_t write_attribute(const WedgeMesh& wedges, std::size_t index)
    {
        const SurfaceAttribute& attribute = *attributes_[index];
        const std::size_t start = buffer_.size();
        for (std::size_t wedge = 0; wedge < wedges.vertices.size(); ++wedge)
        {
            const std::size_t value = wedges.values[wedge * attributes_.size() + index];
            append_value(attribute, value);
        }
        return add_accessor(
            float_accessor(wedges.vertices.size(), attribute.components), start, kArrayBuffer
        );
    }

    /// Normals must have length 1 in glTF; those that have it to the last digits stay as they are.
    void append_value(const SurfaceAttribute& attribute, std::size_t value)
    {
        const float* const first = attribute.values.data() + value * attribute.components;
        double scale = 1.0;
        if (attribute.kind == AttributeKind::Normal)
        {
            const double length = std::hypot(first[0], first[1], first[2]);
            if (!(length > 0.0))
            {
                append_float(buffer_, 0.0);
                append_float(buffer_, 0.0);
                append_float(buffer_, 1.0);
                return;
            }
            scale = std::abs(length - 1.0) > 1e-6 ? 1.0 / length : 1.0;
        }
        for (std::size_t i = 0; i < attribute.components; ++i)
        {
            append_float(buffer_, first[i] * scale);
        }
    }

    std::size_t write_indices(const WedgeMesh& wedges)
    {
        constexpr std::size_t kShortVertices = 65535;  // 65535 itself restarts strips
        const bool is_short = wedges.vertices.size() <= kShortVertices;
        const std::size_t start = buffer_.size();
        for (const Triangle& triangle : wedges.triangles)
        {
            for (const std::uint32_t wedge : triangle)
            {
                is_short ? buffer_.write(static_cast<std::uint16_t>(wedge)) : buffer_.write(wedge);
            }
        }
        json accessor{
            {"componentType", is_short ? kUnsignedShort : kUnsignedInt},
            {"count", 3 * wedges.triangles.size()},
            {"type", "SCALAR"}};
        return add_accessor(std::move(accessor), start, kElementArrayBuffer);
    }

    static json float_accessor(std::size_t count, std::size_t components)
    {
        return {{"componentType", kFloat}, {"count", count}, {"type", type_name(components)}};
    }

    /// Makes a buffer view of everything since `start`. `target`: what it is for; 0: no vertices.
    std::size_t add_view(std::size_t start, int target)
    {
        json view{{"buffer", 0}, {"byteOffset", start}, {"byteLength", buffer_.size() - start}};
        if (target != 0)
        {
            view["target"] = target;
        }
        document_["bufferViews"].push_back(std::move(view));
        while (buffer_.size() % 4 != 0)
        {
            buffer_.write(std::uint8_t{0});
        }
        return document_["bufferViews"].size() - 1;
    }

    std::size_t add_accessor(json accessor, std::size_t start, int target)
    {
        accessor["bufferView"] = add_view(start, target);
        document_["accessors"].push_back(std::move(accessor));
        return document_["accessors"].size() - 1;
    }

    void write_images()
    {
        const auto& used = materials_.used_images();
        for (std::size_t i = 0; i < used.size(); ++i)
        {
            const std::size_t start = buffer_.size();
            buffer_.write_bytes(model_.images[static_cast<std::size_t>(used[i])].bytes);
            document_["images"][i]["bufferView"] = add_view(start, 0);
        }
    }

    /// Header, JSON and buffer; section 4.4.
    Result<WrittenFiles> assemble()
    {
        std::string text = document_.dump(-1, ' ', false, json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::size_t size = 12 + 8 + text.size() + 8 + buffer_.size();
        if (size > std::numeric_limits<std::uint32_t>::max())
        {
            return fail(ErrorCode::InputTooLarge, "GLB files of 4 GiB and more are not possible");
        }
        ByteWriter out;
        append_text(out, "glTF");
        out.write(std::uint32_t{2});
        out.write(static_cast<std::uint32_t>(size));
        out.write(static_cast<std::uint32_t>(text.size()));
        append_text(out, "JSON");
        append_text(out, text);
        out.write(static_cast<std::uint32_t>(buffer_.size()));
        append_text(out, std::string_view("BIN\0", 4));
        out.write_bytes(buffer_.view());
        WrittenFiles files;
        files.push_back({"", out.take()});
        return files;
    }

    const ModelView& model_;
    std::map<std::uint8_t, int> tex_coord_sets_;
    GlbMaterials materials_;
    std::vector<const SurfaceAttribute*> attributes_;  ///< Those that are written.
    std::vector<std::string> names_;                   ///< glTF's names of attributes_.
    json document_ = json::object();
    ByteWriter buffer_;
};

}  // namespace

Result<WrittenFiles> format_glb(const ModelView& model)
{
    return GlbWriter(model).write();
}

}  // namespace vsplit::precompute
