// Based on: Wavefront, "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual; "MTL material
// format", 1995; Exocortex, "Physically-Based Rendering extension for MTL", 2015.
#include "precompute/model_writers.h"
#include "precompute/wedge_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <numeric>
#include <set>

namespace vsplit::precompute {
namespace {

/// The shortest text that reads back as the same number.
template <typename Number>
std::string shortest(Number value)
{
    std::array<char, 40> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), end};
}

/// Text for one line: control characters would end it.
std::string one_line(std::string name)
{
    std::replace_if(
        name.begin(),
        name.end(),
        [](char letter) { return static_cast<unsigned char>(letter) < 0x20; },
        '_'
    );
    return name;
}

/// "x y z" with the nine digits that bring every float back exactly.
std::string point_text(const std::array<double, 3>& point)
{
    std::array<char, 64> line{};
    const int length = std::snprintf(
        line.data(),
        line.size(),
        "%.9g %.9g %.9g",
        static_cast<double>(static_cast<float>(point[0])),
        static_cast<double>(static_cast<float>(point[1])),
        static_cast<double>(static_cast<float>(point[2]))
    );
    return {line.data(), static_cast<std::size_t>(length)};
}

class ObjWriter
{
public:
    ObjWriter(const ModelView& model, const std::string& stem)
        : model_(model),
          stem_(stem),
          tex_coords_(first_of(model, AttributeKind::TexCoord)),
          normals_(first_of(model, AttributeKind::Normal)),
          colors_(first_of(model, AttributeKind::Color))
    {
    }

    WrittenFiles write()
    {
        append_text(out_, "# written by vsplit\n");
        WrittenFiles others;
        if (model_.appearance != nullptr && !model_.appearance->materials.empty())
        {
            name_materials();
            others = write_materials();
            append_text(out_, "mtllib " + stem_ + ".mtl\n");
        }
        write_vertices();
        write_values();
        write_faces();
        WrittenFiles files;
        files.push_back({"", out_.take()});
        std::move(others.begin(), others.end(), std::back_inserter(files));
        return files;
    }

private:
    void name_materials()
    {
        std::set<std::string> taken;
        for (const Material& material : model_.appearance->materials)
        {
            std::string name = one_line(material.name);
            const bool blank = name.find_first_not_of(' ') == name.npos || name.front() == ' ' ||
                               name.back() == ' ';
            if (blank || !taken.insert(name).second)
            {
                name = "material-" + std::to_string(material_names_.size());
                taken.insert(name);
            }
            material_names_.push_back(std::move(name));
        }
    }

    WrittenFiles write_materials()
    {
        std::string text = "# written by vsplit\n";
        for (std::size_t i = 0; i < material_names_.size(); ++i)
        {
            const Material& material = model_.appearance->materials[i];
            const auto& [r, g, b, a] = material.base_color;
            text += "newmtl " + material_names_[i] + "\n";
            text += "Kd " + shortest(r) + " " + shortest(g) + " " + shortest(b) + "\n";
            text += "Pr " + shortest(material.roughness) + "\n";
            text += "Pm " + shortest(material.metallic) + "\n";
            text += material.alpha_mode == AlphaMode::Blend ? "d " + shortest(a) + "\n" : "";
            if (material.emissive != std::array{0.0F, 0.0F, 0.0F})
            {
                const auto& [er, eg, eb] = material.emissive;
                text += "Ke " + shortest(er) + " " + shortest(eg) + " " + shortest(eb) + "\n";
            }
            text += map_text("map_Kd", material.base_color_texture, "");
            text += map_text("map_Ke", material.emissive_texture, "");
            text += map_text(
                "norm", material.normal_texture, "-bm " + shortest(material.normal_scale) + " "
            );
        }
        const auto bytes = std::as_bytes(std::span(text));
        WrittenFiles files;
        files.push_back({stem_ + ".mtl", std::vector<std::byte>(bytes.begin(), bytes.end())});
        for (const std::int32_t image : used_images_)
        {
            files.push_back(
                {image_file_name(model_, image, stem_),
                 model_.images[static_cast<std::size_t>(image)].bytes}
            );
        }
        return files;
    }

    std::string map_text(const char* keyword, const TextureUse& use, const std::string& options)
    {
        const std::string name = image_file_name(model_, use.image, stem_);
        if (name.empty())
        {
            return "";
        }
        used_images_.insert(use.image);
        const bool clamp = use.wrap_u == TextureWrap::Clamp && use.wrap_v == TextureWrap::Clamp;
        return std::string(keyword) + " " + options + (clamp ? "-clamp on " : "") + name + "\n";
    }

    /// A vertex has one colour, so those with several are split.
    void write_vertices()
    {
        if (colors_ == nullptr)
        {
            for (const auto& point : model_.mesh.positions)
            {
                append_text(out_, "v " + point_text(point) + "\n");
            }
            triangles_ = model_.mesh.triangles;
            return;
        }
        std::vector<std::uint32_t> faces(model_.mesh.triangles.size());
        std::iota(faces.begin(), faces.end(), std::uint32_t{0});
        const std::array<const SurfaceAttribute*, 1> splitting{colors_};
        WedgeMesh wedges =
            split_wedges(model_.mesh.triangles, splitting, faces, model_.mesh.positions.size());
        for (std::size_t i = 0; i < wedges.vertices.size(); ++i)
        {
            const std::size_t first = wedges.values[i] * std::size_t{colors_->components};
            append_text(
                out_,
                "v " + point_text(model_.mesh.positions[wedges.vertices[i]]) + " " +
                    shortest(colors_->values[first]) + " " + shortest(colors_->values[first + 1]) +
                    " " + shortest(colors_->values[first + 2]) + "\n"
            );
        }
        triangles_ = std::move(wedges.triangles);
    }

    void write_values()
    {
        for (std::size_t i = 0; tex_coords_ != nullptr && i < tex_coords_->size(); ++i)
        {
            const float* const value = tex_coords_->values.data() + 2 * i;
            // Exact in double precision, and the reader takes it from 1 again there.
            append_text(
                out_, "vt " + shortest(value[0]) + " " + shortest(1.0 - double{value[1]}) + "\n"
            );
        }
        for (std::size_t i = 0; normals_ != nullptr && i < normals_->size(); ++i)
        {
            const float* const value = normals_->values.data() + 3 * i;
            append_text(
                out_,
                "vn " + shortest(value[0]) + " " + shortest(value[1]) + " " + shortest(value[2]) +
                    "\n"
            );
        }
    }

    void write_faces()
    {
        constexpr std::uint32_t kNoGroup = 0xFFFFFFFF;
        std::uint32_t current = kNoGroup;
        for (std::size_t face = 0; face < triangles_.size(); ++face)
        {
            const std::uint32_t group = model_.groups.empty() ? 0 : model_.groups[face];
            if (group != current)
            {
                start_group(group);
                current = group;
            }
            std::string line = "f";
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                line += " " + corner_text(face, corner);
            }
            append_text(out_, line + "\n");
        }
    }

    void start_group(std::uint32_t group)
    {
        if (model_.appearance == nullptr || group >= model_.appearance->groups.size())
        {
            return;
        }
        const FaceGroup& row = model_.appearance->groups[group];
        const bool named = !row.name.empty() || model_.appearance->groups.size() > 1;
        append_text(out_, named ? "g " + one_line(row.name) + "\n" : "");
        if (row.material >= 0 && static_cast<std::size_t>(row.material) < material_names_.size())
        {
            const auto material = static_cast<std::size_t>(row.material);
            append_text(out_, "usemtl " + material_names_[material] + "\n");
        }
    }

    [[nodiscard]] std::string corner_text(std::size_t face, std::size_t corner) const
    {
        std::string text = std::to_string(triangles_[face][corner] + 1);
        if (tex_coords_ == nullptr && normals_ == nullptr)
        {
            return text;
        }
        const auto number = [&](const SurfaceAttribute& attribute) {
            return std::to_string(attribute.corners[face][corner] + 1);
        };
        text += "/";
        text += tex_coords_ == nullptr ? "" : number(*tex_coords_);
        return normals_ == nullptr ? text : text + "/" + number(*normals_);
    }

    const ModelView& model_;
    const std::string& stem_;
    const SurfaceAttribute* tex_coords_;
    const SurfaceAttribute* normals_;
    const SurfaceAttribute* colors_;
    std::vector<std::string> material_names_;
    std::set<std::int32_t> used_images_;
    std::vector<Triangle> triangles_;
    ByteWriter out_;
};

}  // namespace

WrittenFiles format_obj(const ModelView& model, const std::string& stem)
{
    return ObjWriter(model, stem).write();
}

}  // namespace vsplit::precompute
