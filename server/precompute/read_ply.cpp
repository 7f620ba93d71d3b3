// Based on: Turk, "The PLY Polygon File Format", 1994; triangle strips as the Stanford range-image
// tools write them (element "tristrips", -1 between strips).
#include "precompute/corner_table.h"
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/ply_columns.h"
#include "precompute/ply_header.h"
#include "precompute/ply_values.h"
#include "precompute/text_scan.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace vsplit::precompute {
namespace {

template <typename Values>
class BodyReader
{
public:
    BodyReader(Values values, const PlyHeader& header, DroppedNotes& dropped)
        : values_(values), header_(header), dropped_(dropped)
    {
    }

    Result<Surface> read()
    {
        VSPLIT_TRY(check_claims());
        for (const PlyElement& element : header_.elements)
        {
            if (element.name == "vertex")
            {
                VSPLIT_TRY(read_vertices(element));
            }
            else
            {
                VSPLIT_TRY(read_faces(element));
            }
        }
        return finish();
    }

private:
    static std::size_t smallest_row(const PlyElement& element)
    {
        std::size_t bytes = 0;
        for (const PlyProperty& property : element.properties)
        {
            bytes += Values::smallest(property.count_type.value_or(property.type));
        }
        return bytes;
    }

    /// Refuses a file that is too short for its own header, before anything is allocated.
    Result<void> check_claims()
    {
        std::size_t left = values_.left();
        for (const PlyElement& element : header_.elements)
        {
            const std::size_t row = smallest_row(element);
            if (row > 0 && element.count > left / row)
            {
                const bool vertices = element.name == "vertex";
                return fail(
                    ErrorCode::NotAMesh,
                    "the header claims " + std::to_string(element.count) +
                        (vertices ? " vertices" : " rows of '" + element.name + "'") +
                        " but the file has " + size_in_words(values_.offset() + values_.left())
                );
            }
            left -= row * static_cast<std::size_t>(element.count);
        }
        return {};
    }

    Result<void> read_vertices(const PlyElement& element)
    {
        const PlyVertexPlan plan = plan_ply_vertices(element, dropped_);
        if (!plan.has_position)
        {
            return fail(ErrorCode::NotAMesh, "the vertices of the PLY file have no x, y and z");
        }
        attributes_ = plan.attributes;
        const auto rows = static_cast<std::size_t>(element.count);
        builder_.reserve(rows, 0);
        for (SurfaceAttribute& attribute : attributes_)
        {
            attribute.values.assign(rows * attribute.components, 0.0F);
        }
        for (std::size_t row = 0; row < rows; ++row)
        {
            std::array<double, 3> point{};
            for (std::size_t i = 0; i < plan.columns.size(); ++i)
            {
                const PlyProperty& property = element.properties[i];
                VSPLIT_TRY(read_vertex_value(property, plan.columns[i], row, point));
            }
            VSPLIT_TRY(builder_.add_vertex(point));
        }
        return {};
    }

    Result<void> read_vertex_value(
        const PlyProperty& property,
        const PlyColumn& column,
        std::size_t row,
        std::array<double, 3>& point
    )
    {
        if (column.target == PlyColumn::Target::Skip)
        {
            return skip(property);
        }
        const auto value = values_.number(property.type);
        if (!value)
        {
            return broken();
        }
        if (column.target == PlyColumn::Target::Position)
        {
            point[column.component] = *value;
            return {};
        }
        SurfaceAttribute& attribute = attributes_[column.attribute];
        attribute.values[row * attribute.components + column.component] =
            to_float(*value * column.scale + column.offset);
        return {};
    }

    /// Faces, strips, and every other element, whose rows are passed over.
    Result<void> read_faces(const PlyElement& element)
    {
        if (smallest_row(element) == 0)
        {
            return {};
        }
        const bool strips = element.name == "tristrips";
        const bool used = strips || element.name == "face";
        builder_.reserve(0, used && !strips ? static_cast<std::size_t>(element.count) : 0);
        note_unused(element, used);
        for (std::uint64_t row = 0; row < element.count; ++row)
        {
            corners_.clear();
            coordinates_.clear();
            for (const PlyProperty& property : element.properties)
            {
                const PlyFaceUse use = used ? ply_face_use(property) : PlyFaceUse::Skip;
                VSPLIT_TRY(
                    use == PlyFaceUse::Corners     ? read_corners(property)
                    : use == PlyFaceUse::TexCoords ? read_coordinates(property)
                                                   : skip(property)
                );
            }
            first_triangle_ = builder_.triangle_count();
            VSPLIT_TRY(strips ? builder_.add_strip(corners_) : builder_.add_polygon(corners_));
            add_wedges(strips);
        }
        return {};
    }

    void note_unused(const PlyElement& element, bool used)
    {
        if (!used && element.count > 0)
        {
            dropped_.add("element '" + element.name + "'");
        }
        for (const PlyProperty& property : element.properties)
        {
            if (used && ply_face_use(property) == PlyFaceUse::Skip)
            {
                dropped_.add("face property '" + property.name + "'");
            }
        }
    }

    Result<void> read_corners(const PlyProperty& property)
    {
        const auto count = list_length(property);
        if (!count)
        {
            return tl::unexpected<Error>(count.error());
        }
        corners_.clear();
        for (std::size_t i = 0; i < *count; ++i)
        {
            const auto value = values_.number(property.type);
            // The bounds keep the conversion defined; no index comes near them.
            if (!value || !(std::abs(*value) < 1e15) || *value != std::floor(*value))
            {
                return broken();
            }
            corners_.push_back(static_cast<std::int64_t>(*value));
        }
        return {};
    }

    Result<void> read_coordinates(const PlyProperty& property)
    {
        const auto count = list_length(property);
        if (!count)
        {
            return tl::unexpected<Error>(count.error());
        }
        coordinates_.clear();
        for (std::size_t i = 0; i < *count; ++i)
        {
            const auto value = values_.number(property.type);
            if (!value)
            {
                return broken();
            }
            coordinates_.push_back(to_float(i % 2 == 0 ? *value : 1.0 - *value));
        }
        return {};
    }

    /// Gives the triangles of a face the texture coordinates of its corners, if it has them.
    void add_wedges(bool strips)
    {
        if (strips || coordinates_.empty() || coordinates_.size() != 2 * corners_.size())
        {
            return;
        }
        wedge_corners_.clear();
        for (std::size_t i = 0; i < coordinates_.size(); i += 2)
        {
            wedge_corners_.push_back(wedges_.add_value(std::span(coordinates_).subspan(i, 2)));
        }
        wedges_.pad(first_triangle_);
        wedges_.add_polygon(wedge_corners_);
    }

    Result<Surface> finish()
    {
        const std::size_t vertices = builder_.vertex_count();
        auto mesh = builder_.finish();
        if (!mesh)
        {
            return tl::unexpected<Error>(mesh.error());
        }
        Surface surface;
        for (SurfaceAttribute& attribute : attributes_)
        {
            // They differ only when the file has several tables of vertices.
            if (attribute.size() == vertices)
            {
                attribute.corners = mesh->triangles;
                surface.attributes.push_back(std::move(attribute));
            }
        }
        if (wedges_.used())
        {
            std::erase_if(surface.attributes, [](const SurfaceAttribute& attribute) {
                return attribute.kind == AttributeKind::TexCoord;
            });
            std::size_t bad = 0;
            surface.attributes.push_back(
                wedges_.finish(mesh->triangles.size(), std::array{0.0F, 0.0F}, bad)
            );
        }
        surface.mesh = std::move(*mesh);
        return surface;
    }

    Result<void> skip(const PlyProperty& property)
    {
        if (!property.count_type)
        {
            return values_.skip(property.type) ? Result<void>{} : broken();
        }
        const auto count = list_length(property);
        if (!count)
        {
            return tl::unexpected<Error>(count.error());
        }
        for (std::size_t i = 0; i < *count; ++i)
        {
            if (!values_.skip(property.type))
            {
                return broken();
            }
        }
        return {};
    }

    /// Reads the length of a list and checks it against what is left of the file.
    Result<std::size_t> list_length(const PlyProperty& property)
    {
        const auto count = values_.number(*property.count_type);
        const std::size_t most = values_.left() / Values::smallest(property.type);
        if (!count || !(*count >= 0.0) || !(*count <= static_cast<double>(most)) ||
            *count != std::floor(*count))
        {
            return broken();
        }
        return static_cast<std::size_t>(*count);
    }

    tl::unexpected<Error> broken() const
    {
        const bool ended = values_.left() <= 1;
        return fail(
            ErrorCode::NotAMesh,
            ended ? "the file ends before the rows that its PLY header announces"
                  : "the rows of the PLY file do not match its header",
            values_.offset()
        );
    }

    Values values_;
    const PlyHeader& header_;
    DroppedNotes& dropped_;
    MeshBuilder builder_;
    std::vector<SurfaceAttribute> attributes_;        ///< Of the vertices.
    CornerTable wedges_{AttributeKind::TexCoord, 2};  ///< Of the faces' corners.
    std::vector<std::int64_t> corners_;               ///< Of the face that is read.
    std::vector<float> coordinates_;                  ///< Of the face that is read.
    std::vector<std::int64_t> wedge_corners_;         ///< Of the face that is read.
    std::size_t first_triangle_ = 0;                  ///< Of the face that is read.
};

Result<Surface> read_body(
    std::span<const std::byte> bytes, const PlyHeader& header, DroppedNotes& dropped
)
{
    if (header.format == PlyFormat::Ascii)
    {
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        return BodyReader(AsciiValues(text, header.body_offset), header, dropped).read();
    }
    const bool big_endian = header.format == PlyFormat::BigEndian;
    return BodyReader(BinaryValues(bytes, header.body_offset, big_endian), header, dropped).read();
}

/// Gives the model the image that a comment names, when texture coordinates place it.
void add_texture(
    const PlyHeader& header, const ReadCompanion& read, SourceModel& model, DroppedNotes& dropped
)
{
    const bool placed = std::ranges::any_of(model.surface.attributes, [](const auto& attribute) {
        return attribute.kind == AttributeKind::TexCoord;
    });
    if (!placed || header.textures.empty() || !read)
    {
        return;
    }
    if (header.textures.size() > 1)
    {
        dropped.add("all textures but the first");
    }
    ImageCollector images(read, dropped);
    Material material;
    material.metallic = 0.0F;
    material.base_color_texture.image = images.add_file(header.textures.front());
    images.finish(model);
    if (material.base_color_texture.image >= 0)
    {
        model.appearance.materials.push_back(std::move(material));
        model.appearance.groups.push_back({"", 0});
    }
}

}  // namespace

Result<SourceModel> read_ply_model(std::span<const std::byte> bytes, const ReadCompanion& read)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto header = parse_ply_header(text);
    if (!header)
    {
        return tl::unexpected<Error>(header.error());
    }
    DroppedNotes dropped;
    SourceModel model;
    auto surface = read_body(bytes, *header, dropped);
    if (!surface)
    {
        return tl::unexpected<Error>(surface.error());
    }
    model.surface = std::move(*surface);
    add_texture(*header, read, model, dropped);
    tidy_attributes(model.surface, dropped);
    model.dropped = dropped.take();
    return model;
}

}  // namespace vsplit::precompute
