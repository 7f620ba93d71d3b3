#include "commands.h"
#include "decoded_model.h"
#include "mesh/quantization_grid.h"
#include "precompute/code_attributes.h"
#include "precompute/repair_surface.h"
#include "precompute/surface_io.h"
#include "precompute/validate.h"
#include "report.h"
#include "stream_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vsplit::tools {
namespace {

struct VerifyArguments
{
    std::string file;
    std::string against;
};

using GridPoint = std::array<std::int32_t, 3>;

tl::unexpected<Error> mismatch(const std::string& what)
{
    return fail(ErrorCode::Mismatch, what);
}

std::string counts(std::size_t vertices, std::size_t faces)
{
    return std::to_string(vertices) + " vertices and " + std::to_string(faces) + " faces";
}

/// Follows a decoding and compares what comes out with the index.
class IndexCheck
{
public:
    explicit IndexCheck(const codec::StreamInfo& info) : info_(info) {}

    Result<void> operator()(const codec::Step& step)
    {
        if (step.kind == codec::StepKind::Header)
        {
            return {};
        }
        const codec::ChunkInfo& chunk = info_.chunks[chunk_++];
        if (step.vertices != chunk.vertices || step.faces != chunk.faces)
        {
            return mismatch(
                "chunk " + std::to_string(chunk_ - 1) + " gives " +
                counts(step.vertices, step.faces) + " where the index says " +
                counts(chunk.vertices, chunk.faces)
            );
        }
        if (!step.level_complete)
        {
            return {};
        }
        const codec::LevelInfo& level = info_.levels[level_];
        if (step.level != level_ || step.vertices != level.vertices || step.faces != level.faces)
        {
            return mismatch("level " + std::to_string(level_) + " is not what the index says");
        }
        ++level_;
        return {};
    }

    /// Checks that nothing of the index was left out.
    [[nodiscard]] Result<void> finish() const
    {
        const bool all = chunk_ == info_.chunks.size() && level_ == info_.levels.size();
        return all ? Result<void>{} : mismatch("the stream ends before its last level");
    }

private:
    const codec::StreamInfo& info_;
    std::size_t chunk_ = 0;
    std::uint32_t level_ = 0;
};

/// Checks that the file is as long as its index says.
Result<void> check_length(const StreamFile& stream)
{
    const std::uint64_t expected = stream.info().file_bytes;
    if (stream.size() < expected)
    {
        return fail(
            ErrorCode::Truncated,
            stream.path().string() + " should have " + std::to_string(expected) + " bytes",
            stream.size()
        );
    }
    if (stream.size() > expected)
    {
        return fail(
            ErrorCode::TrailingBytes,
            stream.path().string() + ": bytes follow the end of the stream",
            expected
        );
    }
    return {};
}

/// A triangle's three corners: for each its position, then the coded numbers of its attributes, at the end the
/// triangle's group.
using CornerNumbers = std::vector<std::int32_t>;

/// What lies on a mesh, with one value a wedge.
struct WedgeValues
{
    std::span<const Triangle> wedges;  ///< Empty: nothing lies on it.
    std::span<const codec::AttributeInfo> attributes;
    std::span<const std::vector<std::int32_t>> values;
    std::span<const std::uint32_t> groups;
};

/// The numbers of three corners, one corner after another from `first` on.
CornerNumbers joined(const std::array<CornerNumbers, 3>& corners, std::size_t first)
{
    CornerNumbers numbers;
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
        const CornerNumbers& corner = corners[(first + k) % corners.size()];
        numbers.insert(numbers.end(), corner.begin(), corner.end());
    }
    return numbers;
}

/// All triangles as the numbers of their corners, each in its smallest rotation, sorted: equal exactly when the
/// same oriented triangles are there, whatever the order of vertices and faces.
std::vector<CornerNumbers> canonical_triangles(const GridMesh& mesh, const WedgeValues& on)
{
    std::vector<CornerNumbers> triangles;
    triangles.reserve(mesh.triangles.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    {
        std::array<CornerNumbers, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const GridPoint& point = mesh.positions[mesh.triangles[f][k]];
            corners[k].assign(point.begin(), point.end());
            for (std::size_t a = 0; a < on.values.size() && !on.wedges.empty(); ++a)
            {
                const std::size_t numbers = codec::coded_components(on.attributes[a]);
                const auto value =
                    std::span(on.values[a]).subspan(on.wedges[f][k] * numbers, numbers);
                corners[k].insert(corners[k].end(), value.begin(), value.end());
            }
        }
        // The least corner would not tell the rotation where the grid makes two corners one.
        CornerNumbers triangle = joined(corners, 0);
        for (const std::size_t first : {std::size_t{1}, std::size_t{2}})
        {
            triangle = std::min(triangle, joined(corners, first));
        }
        triangle.push_back(on.groups.empty() ? 0 : static_cast<std::int32_t>(on.groups[f]));
        triangles.push_back(std::move(triangle));
    }
    std::ranges::sort(triangles);
    return triangles;
}

std::vector<GridPoint> sorted_positions(const GridMesh& mesh)
{
    std::vector<GridPoint> positions = mesh.positions;
    std::sort(positions.begin(), positions.end());
    return positions;
}

/// A vertex of the source: its position and how many copies it was cut into.
using SourceVertex = std::pair<GridPoint, std::uint32_t>;

/// The vertices that stitching gives, sorted. `stitches`: per vertex the one it is one with, or empty.
std::vector<SourceVertex> stitched_vertices(
    std::span<const std::uint32_t> stitches, const std::vector<GridPoint>& positions
)
{
    std::vector<SourceVertex> vertices;
    for (const GridPoint& position : positions)
    {
        vertices.emplace_back(position, stitches.empty() ? 1 : 0);
    }
    for (const std::uint32_t source : stitches)
    {
        ++vertices[source].second;
    }
    std::erase_if(vertices, [](const SourceVertex& vertex) { return vertex.second == 0; });
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

/// Compares what lies on the meshes, too.
Result<void> compare_triangles(
    const codec::StreamDecoder& decoder,
    const GridMesh& decoded,
    const GridMesh& expected,
    const precompute::EncodeInput& source
)
{
    if (canonical_triangles(decoded, {}) != canonical_triangles(expected, {}))
    {
        return mismatch("the triangles are not those of the quantised source");
    }
    const codec::LevelAttributes* const attributes = decoder.attributes();
    const WedgeValues wanted{source.wedges, source.attributes, source.values, source.groups};
    const WedgeValues found = attributes == nullptr ? WedgeValues{}
                                                    : WedgeValues{
                                                          attributes->wedges,
                                                          decoder.info()->attributes,
                                                          attributes->values,
                                                          attributes->groups};
    if (canonical_triangles(decoded, found) != canonical_triangles(expected, wanted))
    {
        return mismatch("attributes or groups are not those of the quantised source");
    }
    return {};
}

Result<void> compare(const codec::StreamDecoder& decoder, const precompute::EncodeInput& source)
{
    const QuantizationGrid& grid = decoder.info()->grid;
    const QuantizationGrid expected_grid = make_grid(source.mesh.positions, grid.bits);
    if (expected_grid.origin != grid.origin || expected_grid.cell != grid.cell)
    {
        return mismatch("the stream's grid is not the source's");
    }
    const GridMesh decoded = codec::extract_grid_mesh(decoder);
    const GridMesh expected = quantize(grid, source.mesh);
    if (decoded.positions.size() != expected.positions.size() ||
        decoded.triangles.size() != expected.triangles.size())
    {
        return mismatch(
            "the stream has " + counts(decoded.positions.size(), decoded.triangles.size()) +
            ", the repaired source has " +
            counts(expected.positions.size(), expected.triangles.size())
        );
    }
    if (sorted_positions(decoded) != sorted_positions(expected))
    {
        return mismatch("the positions are not those of the quantised source");
    }
    VSPLIT_TRY(compare_triangles(decoder, decoded, expected, source));
    const auto stitched = stitched_vertices(decoder.stitches(), decoded.positions);
    const auto wanted = stitched_vertices(source.stitches, expected.positions);
    if (stitched != wanted)
    {
        return mismatch(
            "stitching gives " + std::to_string(stitched.size()) + " vertices, the source has " +
            std::to_string(wanted.size()) + ", or other ones"
        );
    }
    return {};
}

/// Keeps of a model what the stream has, whose encoder may have been told to drop the rest.
precompute::AttributeBits keep_what_is_coded(const codec::StreamDecoder& decoder, Surface& surface)
{
    precompute::AttributeBits bits;
    const auto& infos = decoder.info()->attributes;
    std::erase_if(surface.attributes, [&](const SurfaceAttribute& attribute) {
        return std::ranges::none_of(infos, [&](const codec::AttributeInfo& info) {
            return info.kind == attribute.kind && info.set == attribute.set;
        });
    });
    for (const codec::AttributeInfo& info : infos)
    {
        precompute::bits_of(bits, info.kind) = info.bits;
    }
    if (decoder.attributes() == nullptr || decoder.attributes()->groups.empty())
    {
        surface.groups.clear();
    }
    return bits;
}

Result<void> check_against(const codec::StreamDecoder& decoder, const std::string& path)
{
    auto model = precompute::read_surface(path);
    VSPLIT_TRY(model);
    const auto bits = keep_what_is_coded(decoder, model->surface);
    auto repaired = precompute::repair_surface(model->surface);
    VSPLIT_TRY(repaired);
    const auto source = precompute::make_encode_input(std::move(*repaired), bits);
    VSPLIT_TRY(source);
    return compare(decoder, *source);
}

Result<void> run(const VerifyArguments& arguments)
{
    auto stream = StreamFile::open(arguments.file);
    VSPLIT_TRY(stream);
    VSPLIT_TRY(check_length(*stream));

    const codec::StreamInfo& info = stream->info();
    codec::StreamDecoder decoder;
    IndexCheck check(info);
    double seconds = 0.0;
    DecodedModel model;
    const auto follow = [&](const codec::Step& step) -> Result<void> {
        VSPLIT_TRY(model.take(step));
        return check(step);
    };
    VSPLIT_TRY(stream->decode(decoder, info.file_bytes, seconds, follow));
    VSPLIT_TRY(check.finish());
    VSPLIT_TRY(model.images());
    const auto manifold = precompute::check_manifold(codec::extract_mesh(decoder, false));
    if (!manifold)
    {
        return mismatch("the last level: " + manifold.error().message);
    }
    if (!arguments.against.empty())
    {
        const auto equal = check_against(decoder, arguments.against);
        VSPLIT_TRY(equal);
    }
    std::printf(
        "verified: %s, %zu levels, %u vertices, %u faces%s%s\n",
        arguments.file.c_str(),
        info.levels.size(),
        info.vertex_count,
        info.face_count,
        arguments.against.empty() ? "" : ", the last level equals the quantised ",
        arguments.against.c_str()
    );
    return {};
}

}  // namespace

void add_verify_command(CLI::App& app, Result<void>& result)
{
    const auto arguments = std::make_shared<VerifyArguments>();
    CLI::App* const command = app.add_subcommand(
        "verify", "Checks a stream: checksums, every level, and that it equals its source"
    );
    command->add_option("FILE", arguments->file, "The stream")->required();
    command->add_option(
        "--against", arguments->against, "The mesh that the last level must equal when quantised"
    );
    command->callback([arguments, &result] { result = run(*arguments); });
}

}  // namespace vsplit::tools
