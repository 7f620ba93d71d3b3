// Decodes noise twice: as it is, and with its checksums made right, because whoever makes a stream
// also makes its checksums. Whatever comes, the mesh must stay usable. Seeds: tests/golden.

#include "codec/stream_decoder.h"
#include "codec/stream_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

using namespace vsplit;

constexpr codec::DecodeLimits kLimits{
    .max_vertices = 1U << 16,
    .max_faces = 1U << 17,
    .max_header_bytes = 1U << 16,
    .max_chunk_bytes = 1U << 20,
    .max_heap_bytes = std::uint64_t{64} << 20,
};

void require(bool condition)
{
    if (!condition)
    {
        std::abort();
    }
}

/// Every triangle has its vertices, every vertex a finite position.
void check_mesh(const codec::StreamDecoder& decoder)
{
    require(decoder.vertices() <= kLimits.max_vertices && decoder.faces() <= kLimits.max_faces);
    std::vector<Triangle> triangles(decoder.faces());
    decoder.write_triangles(triangles);
    for (const Triangle& triangle : triangles)
    {
        require(std::ranges::all_of(triangle, [&](std::uint32_t vertex) {
            return vertex < decoder.vertices();
        }));
    }
    std::vector<float> positions(std::size_t{3} * decoder.vertices());
    decoder.write_positions(0, decoder.vertices(), positions);
    require(std::ranges::none_of(positions, [](float x) { return std::isnan(x); }));
}

void check_step(const codec::StreamDecoder& decoder, const codec::Step& step)
{
    require(step.vertices == decoder.vertices() && step.faces == decoder.faces());
    for (const codec::TriangleUpdate& update : step.triangles)
    {
        require(update.slot < decoder.faces());
    }
}

/// Steps until more bytes are wanted. False after an error, which must stay.
bool step_all(codec::StreamDecoder& decoder)
{
    while (true)
    {
        const auto step = decoder.step();
        if (!step)
        {
            const auto again = decoder.step();
            require(!again && again.error().code == step.error().code);
            return false;
        }
        check_step(decoder, *step);
        if (step->kind == codec::StepKind::NeedBytes || step->kind == codec::StepKind::Complete)
        {
            return true;
        }
    }
}

void decode(std::span<const std::byte> stream, std::size_t piece)
{
    codec::StreamDecoder decoder(kLimits);
    while (!stream.empty())
    {
        const auto taken = decoder.feed(stream.first(std::min(piece, stream.size())));
        if (!taken || !step_all(decoder))
        {
            break;
        }
        if (*taken == 0 && decoder.wanted_bytes() == 0)
        {
            break;
        }
        stream = stream.subspan(*taken);
    }
    check_mesh(decoder);
    static_cast<void>(codec::extract_mesh(decoder));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto input = std::as_bytes(std::span(data, size));
    decode(input, std::max<std::size_t>(size, 1));
    test::Bytes repaired(input.begin(), input.end());
    test::repair_checksums(repaired);
    decode(repaired, 1 + size % 97);
    return 0;
}
