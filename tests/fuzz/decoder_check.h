#pragma once

#include "codec/refinement_mesh.h"
#include "codec/stream_decoder.h"
#include "mesh/indexed_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace vsplit::fuzz {

/// Stops the fuzzer when something does not hold.
inline void require(bool holds)
{
    if (!holds)
    {
        std::abort();
    }
}

/// Bounds that keep the fuzzer quick.
inline constexpr codec::DecodeLimits kLimits{
    .max_vertices = 1U << 16,
    .max_faces = 1U << 17,
    .max_header_bytes = 1U << 16,
    .max_chunk_bytes = 1U << 20,
    .max_heap_bytes = std::uint64_t{16} << 20,
};

/// What a caller may count on after the last step, be it an error: a manifold on the grid. It is linked
/// anew from its triangles, as a base mesh would be.
inline void check_mesh(const codec::StreamDecoder& decoder)
{
    GridMesh mesh;
    mesh.triangles.resize(decoder.faces());
    decoder.write_triangles(mesh.triangles);
    for (std::uint32_t v = 0; v < decoder.vertices(); ++v)
    {
        mesh.positions.push_back(decoder.grid_position(v));
    }
    if (mesh.positions.empty())
    {
        require(mesh.triangles.empty());
        return;
    }
    codec::RefinementMesh linked;
    linked.reserve(decoder.vertices(), decoder.faces());
    const auto most = decoder.info()->grid.max_index() >> decoder.shift();
    require(linked.set_base(mesh, most).has_value());
    std::vector<float> positions(mesh.positions.size() * 3);
    decoder.write_positions(0, decoder.vertices(), positions);
    require(std::ranges::none_of(positions, [](float x) { return std::isnan(x); }));
    static_cast<void>(codec::extract_mesh(decoder));
}

/// What a caller may count on when attributes are complete: indices in range, every wedge at corners of its
/// vertex, values in range that turn into finite numbers.
inline void check_attributes(const codec::StreamDecoder& decoder)
{
    const codec::LevelAttributes& shown = *decoder.attributes();
    const auto& infos = decoder.info()->attributes;
    const std::size_t wedges = shown.wedge_vertices.size();
    std::vector<Triangle> triangles(decoder.faces());
    decoder.write_triangles(triangles);
    require(shown.wedges.size() == triangles.size() && wedges <= decoder.info()->wedge_count);
    for (std::size_t slot = 0; slot < triangles.size(); ++slot)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            require(shown.wedges[slot][k] < wedges);
            require(shown.wedge_vertices[shown.wedges[slot][k]] == triangles[slot][k]);
        }
    }
    require(shown.groups.empty() || shown.groups.size() == triangles.size());
    require(std::ranges::all_of(shown.groups, [](std::uint32_t g) { return g < 1U << 16; }));
    require(shown.values.size() == infos.size());
    for (std::size_t a = 0; a < infos.size(); ++a)
    {
        const auto& values = shown.values[a];
        const bool later = infos[a].kind == AttributeKind::Normal && values.empty();
        require(later || values.size() == wedges * codec::coded_components(infos[a]));
        const std::int32_t most = (1 << infos[a].bits) - 1;
        require(std::ranges::all_of(values, [&](std::int32_t x) { return x <= most && x >= -most; })
        );
        std::vector<float> numbers(later ? 0 : wedges * infos[a].components);
        codec::write_values(infos[a], values, numbers);
        require(std::ranges::none_of(numbers, [](float x) { return std::isnan(x); }));
    }
}

/// Feeds a stream in pieces of `piece` bytes and follows every step.
inline void check_stream(std::span<const std::byte> file, std::size_t piece)
{
    codec::StreamDecoder decoder(kLimits);
    std::vector<Triangle> triangles;
    while (true)
    {
        const auto step = decoder.step();
        if (!step)
        {
            require(decoder.step().error().message == step.error().message);
            require(!decoder.feed(file).has_value());
            break;
        }
        require(step->vertices == decoder.vertices() && step->faces == decoder.faces());
        triangles.resize(step->faces);
        for (const codec::TriangleUpdate& update : step->triangles)
        {
            require(update.slot < triangles.size());
            triangles[update.slot] = update.vertices;
        }
        if (step->triangles_replaced)
        {
            decoder.write_triangles(triangles);
        }
        if (step->attributes_complete)
        {
            check_attributes(decoder);
        }
        const std::size_t taken = decoder.feed(file.first(std::min(piece, file.size()))).value();
        file = file.subspan(taken);
        if (step->kind == codec::StepKind::Complete ||
            (step->kind == codec::StepKind::NeedBytes && taken == 0))
        {
            std::vector<Triangle> all(decoder.faces());
            decoder.write_triangles(all);
            require(all == triangles);
            break;
        }
    }
    check_mesh(decoder);
}

}  // namespace vsplit::fuzz
