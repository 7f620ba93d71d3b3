// Decodes the stream on standard input and prints what every level is, as in tests/golden/NAME.txt, so
// that decoders built for different processors can be compared. Needs neither exceptions nor files.

#include "codec/mesh_digest.h"
#include "codec/stream_decoder.h"

#include <array>
#include <cstdio>
#include <span>

namespace vsplit::test {
namespace {

void print_level(const codec::StreamDecoder& decoder)
{
    GridMesh mesh;
    mesh.triangles.resize(decoder.faces());
    decoder.write_triangles(mesh.triangles);
    for (std::uint32_t v = 0; v < decoder.vertices(); ++v)
    {
        mesh.positions.push_back(decoder.grid_position(v));
    }
    std::fputs(describe_level(decoder.level(), decoder.shift(), mesh).c_str(), stdout);
}

/// Decodes all that the decoder has the bytes for.
Result<void> advance(codec::StreamDecoder& decoder)
{
    while (true)
    {
        const auto step = decoder.step();
        VSPLIT_TRY(step);
        if (step->kind == codec::StepKind::NeedBytes || step->kind == codec::StepKind::Complete)
        {
            return {};
        }
        if (step->level_complete)
        {
            print_level(decoder);
        }
        if (step->attributes_complete)
        {
            std::fputs(describe_attributes(*decoder.attributes()).c_str(), stdout);
        }
    }
}

Result<void> run()
{
    std::fputs(kDigestHead, stdout);
    codec::StreamDecoder decoder;
    std::array<std::byte, 4096> buffer{};
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), stdin))
    {
        for (auto rest = std::span<const std::byte>(buffer).first(count); !rest.empty();)
        {
            const auto taken = decoder.feed(rest);
            VSPLIT_TRY(taken);
            if (*taken == 0)
            {
                return fail(ErrorCode::TrailingBytes, "bytes follow the end of the stream");
            }
            rest = rest.subspan(*taken);
            VSPLIT_TRY(advance(decoder));
        }
    }
    if (!decoder.complete())
    {
        return fail(ErrorCode::Truncated, "the stream ends early");
    }
    std::fputs(describe_stitches(decoder.stitches()).c_str(), stdout);
    return {};
}

}  // namespace
}  // namespace vsplit::test

int main()
{
    const auto done = vsplit::test::run();
    if (!done)
    {
        std::fprintf(stderr, "describe_stream: %s\n", done.error().message.c_str());
    }
    return done ? 0 : 1;
}
