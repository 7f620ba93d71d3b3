// Based on: Turk, "The PLY Polygon File Format", 1994; triangle strips as the Stanford range-image
// tools write them (element "tristrips", -1 between strips).
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/ply_header.h"
#include "precompute/text_scan.h"

#include <bit>
#include <cmath>
#include <string>

namespace vsplit::precompute {
namespace {

/// Values of a binary body, in file order.
class BinaryValues
{
public:
    BinaryValues(std::span<const std::byte> bytes, std::size_t offset, bool big_endian)
        : bytes_(bytes), offset_(offset), big_endian_(big_endian)
    {
    }

    [[nodiscard]] std::size_t offset() const { return offset_; }

    [[nodiscard]] std::size_t left() const { return bytes_.size() - offset_; }

    static std::size_t smallest(PlyType type) { return ply_type_bytes(type); }

    bool skip(PlyType type) { return take(ply_type_bytes(type)); }

    std::optional<double> number(PlyType type)
    {
        const std::size_t size = ply_type_bytes(type);
        if (!take(size))
        {
            return std::nullopt;
        }
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i)
        {
            const std::size_t place = big_endian_ ? size - 1 - i : i;
            bits |= static_cast<std::uint64_t>(bytes_[offset_ - size + i]) << (8 * place);
        }
        return convert(type, bits);
    }

private:
    bool take(std::size_t size)
    {
        const bool there = size <= left();
        offset_ += there ? size : 0;
        return there;
    }

    static double convert(PlyType type, std::uint64_t bits)
    {
        switch (type)
        {
            case PlyType::Int8:
                return static_cast<std::int8_t>(bits);
            case PlyType::Int16:
                return static_cast<std::int16_t>(bits);
            case PlyType::Int32:
                return static_cast<std::int32_t>(bits);
            case PlyType::Float32:
                return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
            case PlyType::Float64:
                return std::bit_cast<double>(bits);
            case PlyType::Uint8:
            case PlyType::Uint16:
            case PlyType::Uint32:
                break;
        }
        return static_cast<double>(bits);
    }

    std::span<const std::byte> bytes_;
    std::size_t offset_;
    bool big_endian_;
};

/// Values of an ascii body, in file order; lines do not matter.
class AsciiValues
{
public:
    AsciiValues(std::string_view text, std::size_t offset)
        : rest_(text.substr(offset)), size_(text.size())
    {
    }

    [[nodiscard]] std::size_t offset() const { return size_ - rest_.size(); }

    /// One more than the characters left: the last value needs no blank behind it.
    [[nodiscard]] std::size_t left() const { return rest_.size() + 1; }

    /// A digit and a blank.
    static std::size_t smallest(PlyType /*type*/) { return 2; }

    bool skip(PlyType /*type*/) { return !take_token(rest_).empty(); }

    std::optional<double> number(PlyType /*type*/) { return parse_real(take_token(rest_)); }

private:
    std::string_view rest_;
    std::size_t size_;
};

/// What a reader does with a property.
enum class Use : std::uint8_t
{
    Skip,
    X,
    Y,
    Z,
    Corners,
};

Use vertex_use(const PlyProperty& property)
{
    if (property.count_type || property.name.size() != 1)
    {
        return Use::Skip;
    }
    switch (property.name.front())
    {
        case 'x':
            return Use::X;
        case 'y':
            return Use::Y;
        case 'z':
            return Use::Z;
        default:
            return Use::Skip;
    }
}

Use face_use(const PlyProperty& property)
{
    const bool named = property.name == "vertex_indices" || property.name == "vertex_index";
    return named && property.count_type ? Use::Corners : Use::Skip;
}

template <typename Values>
class BodyReader
{
public:
    BodyReader(Values values, const PlyHeader& header) : values_(values), header_(header) {}

    Result<IndexedMesh> read()
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
        return builder_.finish();
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
        std::vector<Use> uses;
        unsigned axes = 0;
        for (const PlyProperty& property : element.properties)
        {
            uses.push_back(vertex_use(property));
            axes |= 1U << static_cast<unsigned>(uses.back());
        }
        constexpr unsigned kAllAxes = 0b1110;
        if ((axes & kAllAxes) != kAllAxes)
        {
            return fail(ErrorCode::NotAMesh, "the vertices of the PLY file have no x, y and z");
        }
        builder_.reserve(static_cast<std::size_t>(element.count), 0);
        for (std::uint64_t row = 0; row < element.count; ++row)
        {
            std::array<double, 3> point{};
            for (std::size_t i = 0; i < uses.size(); ++i)
            {
                VSPLIT_TRY(read_vertex_value(element.properties[i], uses[i], point));
            }
            VSPLIT_TRY(builder_.add_vertex(point));
        }
        return {};
    }

    Result<void> read_vertex_value(
        const PlyProperty& property, Use use, std::array<double, 3>& point
    )
    {
        if (use == Use::Skip)
        {
            return skip(property);
        }
        const auto value = values_.number(property.type);
        if (!value)
        {
            return broken();
        }
        point[static_cast<std::size_t>(use) - static_cast<std::size_t>(Use::X)] = *value;
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
        for (std::uint64_t row = 0; row < element.count; ++row)
        {
            for (const PlyProperty& property : element.properties)
            {
                const Use use = used ? face_use(property) : Use::Skip;
                VSPLIT_TRY(use == Use::Skip ? skip(property) : read_corners(property, strips));
            }
        }
        return {};
    }

    Result<void> read_corners(const PlyProperty& property, bool strip)
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
        return strip ? builder_.add_strip(corners_) : builder_.add_polygon(corners_);
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
    MeshBuilder builder_;
    std::vector<std::int64_t> corners_;
};

}  // namespace

Result<IndexedMesh> read_ply(std::span<const std::byte> bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto header = parse_ply_header(text);
    if (!header)
    {
        return tl::unexpected<Error>(header.error());
    }
    if (header->format == PlyFormat::Ascii)
    {
        return BodyReader(AsciiValues(text, header->body_offset), *header).read();
    }
    const bool big_endian = header->format == PlyFormat::BigEndian;
    return BodyReader(BinaryValues(bytes, header->body_offset, big_endian), *header).read();
}

}  // namespace vsplit::precompute
