// Based on: Geomview manual, "OFF Files"; one vertex or face a line, as all writers in use do.
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/text_scan.h"

#include <string>
#include <vector>

namespace vsplit::precompute {
namespace {

/// Lines of an OFF file without comments and empty ones.
class OffLines
{
public:
    explicit OffLines(std::string_view text) : lines_(text), size_(text.size()) {}

    /// Takes the next line that says something; nothing at the end.
    std::optional<std::string_view> next()
    {
        for (auto line = lines_.next(); line; line = lines_.next())
        {
            const std::string_view content = line->substr(0, line->find('#'));
            std::string_view probe = content;
            if (!take_token(probe).empty())
            {
                return content;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::size_t left() const { return size_ - lines_.offset(); }

    /// Error for the line that next() gave, or for the end of the file.
    [[nodiscard]] tl::unexpected<Error> broken(bool ended, std::string_view wanted) const
    {
        return fail(
            ErrorCode::NotAMesh,
            (ended ? "the file ends before "
                   : "line " + std::to_string(lines_.line_number()) + " is not ") +
                std::string(wanted)
        );
    }

private:
    LineReader lines_;
    std::size_t size_;
};

/// Checks the first word: [ST][C][N][4][n]OFF, three-dimensional and ascii only.
Result<void> check_keyword(std::string_view word, std::string_view rest)
{
    const std::size_t end = word.size() < 3 ? word.npos : word.size() - 3;
    if (end == word.npos || word.substr(end) != "OFF" ||
        word.substr(0, end).find_first_not_of("STCN4n") != word.npos)
    {
        return fail(ErrorCode::NotAMesh, "it does not start with 'OFF', so it is no OFF file");
    }
    const bool four = word.find_first_of("4n") != word.npos;
    if (four || take_token(rest) == "BINARY")
    {
        return fail(
            ErrorCode::UnsupportedInput,
            four ? "OFF files of more than three dimensions are not supported"
                 : "binary OFF files are not supported; save it as ascii OFF or as PLY"
        );
    }
    return {};
}

struct OffCounts
{
    std::size_t vertices = 0;
    std::size_t faces = 0;
};

Result<OffCounts> read_counts(OffLines& lines)
{
    const auto first = lines.next();
    std::string_view rest = first.value_or("");
    const std::string_view keyword = take_token(rest);
    VSPLIT_TRY(check_keyword(keyword, rest));
    std::string_view probe = rest;
    if (take_token(probe).empty())
    {
        rest = lines.next().value_or("");
    }
    const auto vertices = parse_integer(take_token(rest));
    const auto faces = parse_integer(take_token(rest));
    if (!vertices || !faces || *vertices < 0 || *faces < 0)
    {
        return lines.broken(false, "the numbers of vertices and faces");
    }
    // A vertex takes at least "0 0 0" and a face "1 0"; every line but the last has an end.
    const std::size_t left = lines.left() + 1;
    const bool many_vertices = static_cast<std::uint64_t>(*vertices) > left / 6;
    if (many_vertices || static_cast<std::uint64_t>(*faces) > left / 2)
    {
        return fail(
            ErrorCode::NotAMesh,
            "the header claims " + std::to_string(many_vertices ? *vertices : *faces) +
                (many_vertices ? " vertices" : " faces") + " but the file has " +
                size_in_words(left)
        );
    }
    return OffCounts{static_cast<std::size_t>(*vertices), static_cast<std::size_t>(*faces)};
}

Result<void> read_vertex(OffLines& lines, MeshBuilder& builder)
{
    const auto line = lines.next();
    std::string_view rest = line.value_or("");
    std::array<double, 3> point{};
    for (double& coordinate : point)
    {
        const auto value = parse_real(take_token(rest));
        if (!value)
        {
            return lines.broken(!line, "a vertex");
        }
        coordinate = *value;
    }
    return builder.add_vertex(point);
}

Result<void> read_face(OffLines& lines, MeshBuilder& builder, std::vector<std::int64_t>& corners)
{
    const auto line = lines.next();
    std::string_view rest = line.value_or("");
    const auto count = parse_integer(take_token(rest));
    if (!count || *count < 0 || static_cast<std::uint64_t>(*count) > rest.size())
    {
        return lines.broken(!line, "a face");
    }
    corners.clear();
    for (std::int64_t i = 0; i < *count; ++i)
    {
        const auto index = parse_integer(take_token(rest));
        if (!index)
        {
            return lines.broken(false, "a face");
        }
        corners.push_back(*index);
    }
    return builder.add_polygon(corners);
}

}  // namespace

Result<IndexedMesh> read_off(std::string_view text)
{
    OffLines lines(text);
    const auto counts = read_counts(lines);
    if (!counts)
    {
        return tl::unexpected<Error>(counts.error());
    }
    MeshBuilder builder;
    builder.reserve(counts->vertices, counts->faces);
    for (std::size_t i = 0; i < counts->vertices; ++i)
    {
        VSPLIT_TRY(read_vertex(lines, builder));
    }
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < counts->faces; ++i)
    {
        VSPLIT_TRY(read_face(lines, builder, corners));
    }
    return builder.finish();
}

}  // namespace vsplit::precompute
