// Based on: Wavefront, "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
#include "precompute/corner_table.h"
#include "precompute/group_table.h"
#include "precompute/material_library.h"
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::precompute {
namespace {

/// Lines of an OBJ file; a backslash at the end of a line continues it on the next.
class ObjLines
{
public:
    explicit ObjLines(std::string_view text) : lines_(text) {}

    [[nodiscard]] std::size_t line_number() const { return lines_.line_number(); }

    /// Takes the next logical line; valid until the next call.
    std::optional<std::string_view> next()
    {
        auto line = lines_.next();
        if (!line || !line->ends_with('\\'))
        {
            return line;
        }
        joined_.clear();
        while (line && line->ends_with('\\'))
        {
            joined_.append(line->substr(0, line->size() - 1));
            joined_.push_back(' ');
            line = lines_.next();
        }
        joined_.append(line.value_or(""));
        return joined_;
    }

private:
    LineReader lines_;
    std::string joined_;
};

/// The corners of the face that is read: indices of vertices, texture coordinates and normals.
struct ObjCorners
{
    std::vector<std::int64_t> vertices;
    std::vector<std::int64_t> tex_coords;
    std::vector<std::int64_t> normals;

    void clear()
    {
        vertices.clear();
        tex_coords.clear();
        normals.clear();
    }
};

/// What is left of a line without the blanks around it.
std::string trimmed(std::string_view rest)
{
    constexpr std::string_view kBlanks = " \t";
    const std::size_t begin = rest.find_first_not_of(kBlanks);
    const std::size_t end = rest.find_last_not_of(kBlanks);
    return begin == rest.npos ? std::string() : std::string(rest.substr(begin, end + 1 - begin));
}

class ObjReader
{
public:
    ObjReader(std::string_view text, const ReadCompanion& read)
        : lines_(text), read_(read), images_(read, dropped_)
    {
    }

    Result<SourceModel> read()
    {
        for (auto line = lines_.next(); line; line = lines_.next())
        {
            std::string_view rest = *line;
            const std::string_view keyword = take_token(rest);
            VSPLIT_TRY(read_line(keyword, rest));
        }
        return finish();
    }

private:
    Result<void> read_line(std::string_view keyword, std::string_view rest)
    {
        if (keyword == "v")
        {
            return read_vertex(rest);
        }
        if (keyword == "f")
        {
            return read_face(rest);
        }
        if (keyword == "vt" || keyword == "vn")
        {
            read_value(keyword == "vt" ? tex_coords_ : normals_, rest);
        }
        else if (keyword == "g" || keyword == "o")
        {
            end_group();
            group_ = trimmed(rest);
        }
        else if (keyword == "usemtl")
        {
            end_group();
            material_ = find_material(trimmed(rest));
        }
        else if (keyword == "mtllib")
        {
            read_library(trimmed(rest));
        }
        else if (keyword == "l" || keyword == "p" || keyword == "curv" || keyword == "surf")
        {
            dropped_.add("lines, points or curved surfaces ('" + std::string(keyword) + "')");
        }
        return {};
    }

    Result<void> read_vertex(std::string_view rest)
    {
        std::array<double, 3> point{};
        for (double& coordinate : point)
        {
            const auto value = parse_real(take_token(rest));
            if (!value)
            {
                return broken("a vertex of three numbers");
            }
            coordinate = *value;
        }
        VSPLIT_TRY(builder_.add_vertex(point));
        read_color(rest);
        return {};
    }

    /// Colours stand behind the coordinates; a single number there is a weight.
    void read_color(std::string_view rest)
    {
        std::array<float, 3> color{1.0F, 1.0F, 1.0F};
        std::size_t given = 0;
        while (given < 3)
        {
            const auto value = parse_real(take_token(rest));
            if (!value)
            {
                break;
            }
            color[given++] = to_float(*value);
        }
        if (given == 3)
        {
            colors_.resize(3 * (builder_.vertex_count() - 1), 1.0F);
            colors_.insert(colors_.end(), color.begin(), color.end());
        }
    }

    /// A value of too few numbers is kept, so that the others keep their numbers.
    void read_value(CornerTable& table, std::string_view rest)
    {
        std::array<float, 3> value{};
        const bool tex_coord = &table == &tex_coords_;
        for (std::size_t i = 0; i < (tex_coord ? 2 : 3); ++i)
        {
            const double number = parse_real(take_token(rest)).value_or(0.0);
            const bool upwards = tex_coord && i == 1;  // there, and downwards here
            value[i] = to_float(upwards ? 1.0 - number : number);
        }
        table.add_value(std::span(value).first(tex_coord ? 2 : 3));
    }

    Result<void> read_face(std::string_view rest)
    {
        corners_.clear();
        for (auto token = take_token(rest); !token.empty(); token = take_token(rest))
        {
            if (token.front() == '#')
            {
                break;
            }
            VSPLIT_TRY(read_corner(token));
        }
        if (corners_.vertices.empty())
        {
            return broken("a face of vertex indices");
        }
        tex_coords_.pad(builder_.triangle_count());
        normals_.pad(builder_.triangle_count());
        VSPLIT_TRY(builder_.add_polygon(corners_.vertices));
        tex_coords_.add_polygon(corners_.tex_coords);
        normals_.add_polygon(corners_.normals);
        return {};
    }

    /// "vertex", "vertex/texture", "vertex//normal" or "vertex/texture/normal".
    Result<void> read_corner(std::string_view token)
    {
        const std::size_t slash = std::min(token.find('/'), token.size());
        const auto index = parse_integer(token.substr(0, slash));
        if (!index)
        {
            return broken("a face of vertex indices");
        }
        // Indices count from 1; -1 is the vertex that came last.
        const auto known = static_cast<std::int64_t>(builder_.vertex_count());
        const bool counts_back = *index < 0;
        if (*index == 0 || (counts_back && -known > *index))
        {
            return fail(
                ErrorCode::BadIndex,
                "line " + std::to_string(lines_.line_number()) + " refers to vertex " +
                    std::to_string(*index) + " after " + std::to_string(known) + " vertices"
            );
        }
        corners_.vertices.push_back(counts_back ? known + *index : *index - 1);
        const std::string_view others = slash < token.size() ? token.substr(slash + 1) : "";
        const std::size_t second = std::min(others.find('/'), others.size());
        corners_.tex_coords.push_back(value_index(others.substr(0, second), tex_coords_));
        corners_.normals.push_back(
            second < others.size() ? value_index(others.substr(second + 1), normals_) : -1
        );
        return {};
    }

    /// Index of a value from 0; -1 when the corner has none.
    std::int64_t value_index(std::string_view token, const CornerTable& table)
    {
        const auto index = parse_integer(token);
        const auto known = static_cast<std::int64_t>(table.value_count());
        if (!index || *index == 0 || *index < -known)
        {
            bad_corners_ += token.empty() ? 0 : 1;
            return -1;
        }
        return *index < 0 ? known + *index : *index - 1;
    }

    void end_group() { groups_.assign(builder_.triangle_count(), group_, material_); }

    std::int32_t find_material(const std::string& name)
    {
        const auto next = static_cast<std::int32_t>(materials_.size());
        const auto [entry, is_new] = material_by_name_.try_emplace(name, next);
        if (is_new)
        {
            Material material;
            material.name = name;
            material.metallic = 0.0F;
            materials_.push_back(std::move(material));
        }
        return entry->second;
    }

    void read_library(const std::string& name)
    {
        if (!read_)
        {
            return;
        }
        const auto bytes = read_(name);
        if (!bytes)
        {
            dropped_.add("material library '" + name + "': " + bytes.error().message);
            return;
        }
        const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        for (Material& material : read_material_library(text, images_, dropped_))
        {
            Material& target = materials_[static_cast<std::size_t>(find_material(material.name))];
            if (defined_.insert(material.name).second)
            {
                target = std::move(material);
            }
        }
    }

    Result<SourceModel> finish()
    {
        end_group();
        const std::size_t vertices = builder_.vertex_count();
        auto mesh = builder_.finish();
        if (!mesh)
        {
            return tl::unexpected<Error>(mesh.error());
        }
        SourceModel model;
        model.surface.mesh = std::move(*mesh);
        add_attributes(model.surface, vertices);
        groups_.finish(model);
        images_.finish(model);
        model.appearance.materials = std::move(materials_);
        tidy_attributes(model.surface, dropped_);
        model.dropped = dropped_.take();
        return model;
    }

    void add_attributes(Surface& surface, std::size_t vertices)
    {
        const std::size_t triangles = surface.mesh.triangles.size();
        std::size_t late_corners = 0;
        if (tex_coords_.used())
        {
            surface.attributes.push_back(
                tex_coords_.finish(triangles, std::array{0.0F, 0.0F}, late_corners)
            );
            bad_corners_ += late_corners;
        }
        if (normals_.used())
        {
            surface.attributes.push_back(
                normals_.finish(triangles, std::array{0.0F, 0.0F, 0.0F}, late_corners)
            );
            bad_corners_ += late_corners;
        }
        if (bad_corners_ > 0)
        {
            dropped_.add(
                std::to_string(bad_corners_) +
                " references to texture coordinates or normals that do not exist"
            );
        }
        if (!colors_.empty())
        {
            surface.attributes.push_back(colors_of(surface.mesh, vertices));
        }
    }

    SurfaceAttribute colors_of(const IndexedMesh& mesh, std::size_t vertices)
    {
        colors_.resize(3 * vertices, 1.0F);
        const bool bytes = std::ranges::any_of(colors_, [](float value) { return value > 1.0F; });
        for (float& value : colors_)
        {
            value = bytes ? value / 255.0F : value;
        }
        return {AttributeKind::Color, 0, 3, "", std::move(colors_), mesh.triangles};
    }

    [[nodiscard]] tl::unexpected<Error> broken(std::string_view what) const
    {
        return fail(
            ErrorCode::NotAMesh,
            "line " + std::to_string(lines_.line_number()) + " is not " + std::string(what)
        );
    }

    ObjLines lines_;
    const ReadCompanion& read_;
    DroppedNotes dropped_;
    ImageCollector images_;
    MeshBuilder builder_;
    CornerTable tex_coords_{AttributeKind::TexCoord, 2};
    CornerTable normals_{AttributeKind::Normal, 3};
    std::vector<float> colors_;  ///< Of the vertices so far that have some, and those before them.
    GroupTable groups_;
    std::string group_;           ///< Of the faces that come.
    std::int32_t material_ = -1;  ///< Of the faces that come.
    std::vector<Material> materials_;
    std::map<std::string, std::int32_t> material_by_name_;
    std::set<std::string> defined_;  ///< Materials that a library described.
    ObjCorners corners_;
    std::size_t bad_corners_ = 0;
};

}  // namespace

Result<SourceModel> read_obj_model(std::string_view text, const ReadCompanion& read)
{
    return ObjReader(text, read).read();
}

}  // namespace vsplit::precompute
