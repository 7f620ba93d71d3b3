// Based on: Wavefront, "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual.
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/text_scan.h"

#include <string>
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

tl::unexpected<Error> broken(const ObjLines& lines, std::string_view what)
{
    return fail(
        ErrorCode::NotAMesh,
        "line " + std::to_string(lines.line_number()) + " is not " + std::string(what)
    );
}

Result<void> read_vertex(const ObjLines& lines, std::string_view rest, MeshBuilder& builder)
{
    std::array<double, 3> point{};
    for (double& coordinate : point)
    {
        const auto value = parse_real(take_token(rest));
        if (!value)
        {
            return broken(lines, "a vertex of three numbers");
        }
        coordinate = *value;
    }
    return builder.add_vertex(point);
}

Result<void> read_face(
    const ObjLines& lines,
    std::string_view rest,
    MeshBuilder& builder,
    std::vector<std::int64_t>& corners
)
{
    corners.clear();
    for (auto token = take_token(rest); !token.empty(); token = take_token(rest))
    {
        if (token.front() == '#')
        {
            break;
        }
        // "vertex/texture/normal": only the first matters here.
        const auto index = parse_integer(token.substr(0, token.find('/')));
        if (!index)
        {
            return broken(lines, "a face of vertex indices");
        }
        // Indices count from 1; -1 is the vertex that came last.
        const auto known = static_cast<std::int64_t>(builder.vertex_count());
        const bool counts_back = *index < 0;
        if (*index == 0 || (counts_back && -known > *index))
        {
            return fail(
                ErrorCode::BadIndex,
                "line " + std::to_string(lines.line_number()) + " refers to vertex " +
                    std::to_string(*index) + " after " + std::to_string(known) + " vertices"
            );
        }
        corners.push_back(counts_back ? known + *index : *index - 1);
    }
    if (corners.empty())
    {
        return broken(lines, "a face of vertex indices");
    }
    return builder.add_polygon(corners);
}

}  // namespace

Result<IndexedMesh> read_obj(std::string_view text)
{
    ObjLines lines(text);
    MeshBuilder builder;
    std::vector<std::int64_t> corners;
    for (auto line = lines.next(); line; line = lines.next())
    {
        std::string_view rest = *line;
        const std::string_view keyword = take_token(rest);
        if (keyword == "v")
        {
            VSPLIT_TRY(read_vertex(lines, rest, builder));
        }
        else if (keyword == "f")
        {
            VSPLIT_TRY(read_face(lines, rest, builder, corners));
        }
    }
    return builder.finish();
}

}  // namespace vsplit::precompute
