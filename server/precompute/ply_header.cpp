// Based on: Turk, "The PLY Polygon File Format", 1994; type names also as PLY writers use them today.
#include "precompute/ply_header.h"

#include "precompute/text_scan.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vsplit::precompute {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypeNames{{
    {"char", PlyType::Int8},
    {"uchar", PlyType::Uint8},
    {"short", PlyType::Int16},
    {"ushort", PlyType::Uint16},
    {"int", PlyType::Int32},
    {"uint", PlyType::Uint32},
    {"float", PlyType::Float32},
    {"double", PlyType::Float64},
    {"int8", PlyType::Int8},
    {"uint8", PlyType::Uint8},
    {"int16", PlyType::Int16},
    {"uint16", PlyType::Uint16},
    {"int32", PlyType::Int32},
    {"uint32", PlyType::Uint32},
    {"float32", PlyType::Float32},
    {"float64", PlyType::Float64},
}};

std::optional<PlyType> find_type(std::string_view name)
{
    for (const auto& [known, type] : kTypeNames)
    {
        if (known == name)
        {
            return type;
        }
    }
    return std::nullopt;
}

tl::unexpected<Error> bad_header(std::string_view line, std::size_t offset)
{
    constexpr std::size_t kShown = 60;
    std::string shown(line.substr(0, kShown));
    std::replace_if(
        shown.begin(), shown.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?'
    );
    return fail(
        ErrorCode::NotAMesh,
        "the PLY header has a line that is not understood: '" + shown + "'",
        offset
    );
}

std::optional<PlyFormat> find_format(std::string_view name)
{
    if (name == "ascii")
    {
        return PlyFormat::Ascii;
    }
    if (name == "binary_little_endian")
    {
        return PlyFormat::LittleEndian;
    }
    if (name == "binary_big_endian")
    {
        return PlyFormat::BigEndian;
    }
    return std::nullopt;
}

std::optional<PlyElement> parse_element(std::string_view rest)
{
    PlyElement element;
    element.name = std::string(take_token(rest));
    const auto count = parse_integer(take_token(rest));
    if (element.name.empty() || !count || *count < 0)
    {
        return std::nullopt;
    }
    element.count = static_cast<std::uint64_t>(*count);
    return element;
}

std::optional<PlyProperty> parse_property(std::string_view rest)
{
    PlyProperty property;
    std::string_view type_name = take_token(rest);
    if (type_name == "list")
    {
        property.count_type = find_type(take_token(rest));
        const bool counts = property.count_type && *property.count_type != PlyType::Float32 &&
                            *property.count_type != PlyType::Float64;
        if (!counts)
        {
            return std::nullopt;
        }
        type_name = take_token(rest);
    }
    const auto type = find_type(type_name);
    property.name = std::string(take_token(rest));
    if (!type || property.name.empty())
    {
        return std::nullopt;
    }
    property.type = *type;
    return property;
}

/// "comment TextureFile NAME"; names may have blanks.
void take_texture(std::string_view rest, PlyHeader& header)
{
    if (take_token(rest) != "TextureFile")
    {
        return;
    }
    std::string_view probe = rest;
    const std::string_view first = take_token(probe);
    rest.remove_prefix(first.empty() ? rest.size() : first.data() - rest.data());
    rest = rest.substr(0, rest.find_last_not_of(" \t\r") + 1);
    if (!rest.empty())
    {
        header.textures.emplace_back(rest);
    }
}

/// Takes over one header line; false when it makes no sense there.
bool apply_line(std::string_view line, PlyHeader& header, bool& has_format)
{
    std::string_view rest = line;
    const std::string_view keyword = take_token(rest);
    if (keyword == "comment")
    {
        take_texture(rest, header);
        return true;
    }
    if (keyword.empty() || keyword == "obj_info")
    {
        return true;
    }
    if (keyword == "format")
    {
        const auto format = find_format(take_token(rest));
        has_format = format.has_value();
        header.format = format.value_or(PlyFormat::Ascii);
        return has_format;
    }
    if (keyword == "element")
    {
        auto element = parse_element(rest);
        if (element)
        {
            header.elements.push_back(std::move(*element));
        }
        return element.has_value();
    }
    if (keyword == "property" && !header.elements.empty())
    {
        auto property = parse_property(rest);
        if (property)
        {
            header.elements.back().properties.push_back(std::move(*property));
        }
        return property.has_value();
    }
    return false;
}

}  // namespace

Result<PlyHeader> parse_ply_header(std::string_view text)
{
    LineReader lines(text);
    std::string_view magic = lines.next().value_or("");
    const std::string_view first = take_token(magic);
    if (first != "ply" && first != "PLY")
    {
        return fail(ErrorCode::NotAMesh, "it does not start with 'ply', so it is no PLY file");
    }
    PlyHeader header;
    bool has_format = false;
    std::size_t offset = lines.offset();
    for (auto line = lines.next(); line; line = lines.next())
    {
        std::string_view rest = *line;
        if (take_token(rest) == "end_header")
        {
            header.body_offset = lines.offset();
            return has_format ? Result<PlyHeader>(std::move(header))
                              : fail(ErrorCode::NotAMesh, "the PLY header names no format");
        }
        if (!apply_line(*line, header, has_format))
        {
            return bad_header(*line, offset);
        }
        offset = lines.offset();
    }
    return fail(ErrorCode::NotAMesh, "the file ends inside the PLY header", text.size());
}

}  // namespace vsplit::precompute
