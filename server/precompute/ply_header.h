#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vsplit::precompute {

/// Scalar types of PLY.
enum class PlyType : std::uint8_t
{
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64,
};

/// Bytes of a scalar in the binary forms.
[[nodiscard]] constexpr std::size_t ply_type_bytes(PlyType type)
{
    switch (type)
    {
        case PlyType::Int8:
        case PlyType::Uint8:
            return 1;
        case PlyType::Int16:
        case PlyType::Uint16:
            return 2;
        case PlyType::Float64:
            return 8;
        case PlyType::Int32:
        case PlyType::Uint32:
        case PlyType::Float32:
            break;
    }
    return 4;
}

/// How the rows of a PLY file are stored.
enum class PlyFormat : std::uint8_t
{
    Ascii,
    LittleEndian,
    BigEndian,
};

/// One value, or one list of values, of every row of an element.
struct PlyProperty
{
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> count_type;  ///< Set for a list: the type of its length.
};

/// A table of a PLY file.
struct PlyElement
{
    std::string name;
    std::uint64_t count = 0;  ///< Rows, as claimed.
    std::vector<PlyProperty> properties;
};

/// What the header of a PLY file says.
struct PlyHeader
{
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  ///< Images that comments name, as MeshLab writes them.
    std::size_t body_offset = 0;        ///< First byte after the header.
};

/// Parses the header of a PLY file.
/// `text`: the whole file. Errors: NotAMesh. Cost: linear in the header. Nothing is allocated for the
/// counts that it claims. Thread safe. Safe on untrusted input.
[[nodiscard]] Result<PlyHeader> parse_ply_header(std::string_view text);

}  // namespace vsplit::precompute
