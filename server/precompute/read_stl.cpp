// Based on: 3D Systems, "StereoLithography Interface Specification", 1989.
#include "core/byte_reader.h"
#include "precompute/mesh_builder.h"
#include "precompute/mesh_readers.h"
#include "precompute/text_scan.h"

#include <bit>
#include <string>
#include <vector>

namespace vsplit::precompute {
namespace {

constexpr std::size_t kTextHeaderBytes = 80;
constexpr std::size_t kHeaderBytes = kTextHeaderBytes + sizeof(std::uint32_t);
constexpr std::size_t kFacetBytes = 12 * sizeof(float) + sizeof(std::uint16_t);

/// Facets that a binary header claims; nothing when the file is shorter than a header.
std::optional<std::uint32_t> claimed_facets(std::span<const std::byte> bytes)
{
    if (bytes.size() < kHeaderBytes)
    {
        return std::nullopt;
    }
    ByteReader reader(bytes.subspan(kTextHeaderBytes));
    return reader.read<std::uint32_t>().value();
}

Result<IndexedMesh> read_binary(std::span<const std::byte> bytes, std::uint32_t facets)
{
    MeshBuilder builder;
    builder.reserve(std::size_t{3} * facets, facets);
    for (std::size_t facet = 0; facet < facets; ++facet)
    {
        constexpr std::size_t kNormalBytes = 3 * sizeof(float);
        ByteReader reader(bytes.subspan(kHeaderBytes + facet * kFacetBytes + kNormalBytes));
        for (int corner = 0; corner < 3; ++corner)
        {
            std::array<double, 3> point{};
            for (double& coordinate : point)
            {
                coordinate = std::bit_cast<float>(reader.read<std::uint32_t>().value_or(0));
            }
            VSPLIT_TRY(builder.add_vertex(point));
        }
        const auto first = static_cast<std::int64_t>(3 * facet);
        VSPLIT_TRY(builder.add_polygon(std::array{first, first + 1, first + 2}));
    }
    return builder.finish();
}

/// Reads the lines of an ascii file; knows whether it is inside a facet.
class AsciiReader
{
public:
    explicit AsciiReader(std::string_view text) : lines_(text) {}

    Result<IndexedMesh> read()
    {
        for (auto line = lines_.next(); line; line = lines_.next())
        {
            VSPLIT_TRY(read_line(*line));
        }
        if (inside_facet_ || !ended_)
        {
            return fail(ErrorCode::NotAMesh, "the ascii STL file ends before 'endsolid'");
        }
        return builder_.finish();
    }

private:
    Result<void> read_line(std::string_view rest)
    {
        const std::string keyword = lower_case(take_token(rest));
        if (keyword.empty() || keyword == "outer" || keyword == "endloop")
        {
            return {};
        }
        if (keyword == "vertex" && inside_facet_)
        {
            return read_vertex(rest);
        }
        if (keyword == "endfacet" && inside_facet_)
        {
            inside_facet_ = false;
            return corners_.size() >= 3 ? builder_.add_polygon(corners_) : broken();
        }
        const bool starts = keyword == "facet" || keyword == "solid";
        if (inside_facet_ || (!starts && keyword != "endsolid"))
        {
            return broken();
        }
        inside_facet_ = keyword == "facet";
        ended_ = keyword == "endsolid";
        corners_.clear();
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
                return broken();
            }
            coordinate = *value;
        }
        corners_.push_back(static_cast<std::int64_t>(builder_.vertex_count()));
        return builder_.add_vertex(point);
    }

    [[nodiscard]] tl::unexpected<Error> broken() const
    {
        return fail(
            ErrorCode::NotAMesh,
            "line " + std::to_string(lines_.line_number()) + " is not understood as ascii STL"
        );
    }

    LineReader lines_;
    MeshBuilder builder_;
    std::vector<std::int64_t> corners_;
    bool inside_facet_ = false;
    bool ended_ = false;
};

}  // namespace

Result<IndexedMesh> read_stl(std::span<const std::byte> bytes)
{
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto facets = claimed_facets(bytes);
    const std::uint64_t needed = kHeaderBytes + std::uint64_t{kFacetBytes} * facets.value_or(0);
    // Binary files may start with "solid" too: a size that fits exactly decides.
    if (facets && needed == bytes.size())
    {
        return read_binary(bytes, *facets);
    }
    std::string_view start = text;
    if (lower_case(take_token(start)) == "solid")
    {
        return AsciiReader(text).read();
    }
    if (!facets)
    {
        return fail(ErrorCode::NotAMesh, "it is too short for a binary STL file and no ascii one");
    }
    if (needed > bytes.size())
    {
        return fail(
            ErrorCode::NotAMesh,
            "the header claims " + std::to_string(*facets) + " triangles (" +
                size_in_words(needed) + ") but the file has " + size_in_words(bytes.size())
        );
    }
    return read_binary(bytes, *facets);
}

}  // namespace vsplit::precompute
