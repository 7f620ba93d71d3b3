#include "codec/attributed_samples.h"

#include "codec/octahedron.h"
#include "codec/value_coder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace vsplit::test {
namespace {

using codec::AttributeInfo;

/// Numbers of a wedge at a position: waves, of which groups have their own.
void append_value(
    const AttributeInfo& info,
    const std::array<double, 3>& p,
    std::uint32_t group,
    std::vector<std::int32_t>& values
)
{
    if (info.kind == AttributeKind::Normal)
    {
        const std::int32_t half = (1 << (info.bits - 1)) - 1;
        const double lean = 0.1 * group;
        const auto point = codec::octa_point({p[0] + lean, p[1], p[2] - lean}, half);
        const auto [u, v] = codec::unfold(point, {2, 1}, half);
        values.push_back(u + half);
        values.push_back(v + half);
        return;
    }
    for (std::size_t k = 0; k < info.components; ++k)
    {
        const auto [low, high] = codec::number_range(info, k);
        const double wave = std::sin(p[0] + 2.0 * p[1] - p[2] + static_cast<double>(k + group));
        values.push_back(
            low + static_cast<std::int32_t>((0.5 + 0.49 * wave) * static_cast<double>(high - low))
        );
    }
}

/// Begins with the least of the corners; `corners`: three rows of one length.
FaceRow row_of(std::array<FaceRow, 3> corners, std::uint32_t group)
{
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    FaceRow row{static_cast<std::int32_t>(group)};
    for (const FaceRow& corner : corners)
    {
        row.insert(row.end(), corner.begin(), corner.end());
    }
    return row;
}

/// Rows of faces that have wedges at their corners.
std::vector<FaceRow> rows_of(
    const GridMesh& mesh,
    std::span<const AttributeInfo> infos,
    std::span<const Triangle> wedges,
    std::span<const std::uint32_t> groups,
    std::span<const std::vector<std::int32_t>> values
)
{
    std::vector<FaceRow> rows;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    {
        std::array<FaceRow, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto& p = mesh.positions[mesh.triangles[f][k]];
            corners[k].assign(p.begin(), p.end());
            for (std::size_t a = 0; a < infos.size(); ++a)
            {
                const std::size_t numbers = codec::coded_components(infos[a]);
                const auto value = std::span(values[a]).subspan(wedges[f][k] * numbers, numbers);
                corners[k].insert(corners[k].end(), value.begin(), value.end());
            }
        }
        rows.push_back(row_of(std::move(corners), groups.empty() ? 0 : groups[f]));
    }
    std::ranges::sort(rows);
    return rows;
}

}  // namespace

std::vector<AttributeInfo> every_kind()
{
    return {
        {.kind = AttributeKind::TexCoord, .components = 2, .bits = 10},
        {.kind = AttributeKind::Normal, .components = 3, .bits = 8},
        {.kind = AttributeKind::Color, .components = 4, .bits = 8},
        {.kind = AttributeKind::Color, .set = 1, .components = 3, .bits = 5, .rgb = true},
        {.kind = AttributeKind::Scalar, .components = 1, .bits = 16, .name = "warmth"},
    };
}

precompute::EncodeInput attributed(
    const TexturedShape& shape, const std::vector<AttributeInfo>& attributes
)
{
    precompute::EncodeInput input;
    input.mesh = shape.mesh;
    input.wedges = shape.wedges.corners;
    input.groups = shape.groups;
    input.attributes = attributes;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> of_wedge(shape.wedges.count);
    for (std::size_t f = 0; f < shape.wedges.corners.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            of_wedge[shape.wedges.corners[f][k]] = {shape.mesh.triangles[f][k], shape.groups[f]};
        }
    }
    for (const AttributeInfo& info : attributes)
    {
        std::vector<std::int32_t>& values = input.values.emplace_back();
        for (const auto& [vertex, group] : of_wedge)
        {
            append_value(info, shape.mesh.positions[vertex], group, values);
        }
    }
    return input;
}

AttributedSample encode(
    const precompute::EncodeInput& input, const precompute::EncodeOptions& options
)
{
    AttributedSample sample;
    sample.input = input;
    auto encoded = precompute::encode_surface(precompute::EncodeInput(input), options);
    if (!encoded)
    {
        throw std::runtime_error(describe(encoded.error()));
    }
    sample.file = std::move(encoded->file);
    sample.info = std::move(encoded->info);
    return sample;
}

std::vector<FaceRow> face_rows(const AttributedSample& sample)
{
    const precompute::EncodeInput& input = sample.input;
    return rows_of(
        quantize(sample.info.grid, input.mesh),
        input.attributes,
        input.wedges,
        input.groups,
        input.values
    );
}

std::vector<FaceRow> face_rows(const codec::StreamInfo& info, const Decoded& decoded)
{
    const codec::LevelAttributes& shown = decoded.attributes.back().attributes;
    return rows_of(
        decoded.levels.back().mesh, info.attributes, shown.wedges, shown.groups, shown.values
    );
}

}  // namespace vsplit::test
