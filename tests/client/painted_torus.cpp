#include "painted_torus.h"

#include "codec/stream_parts.h"
#include "image/texture_encoder.h"
#include "painted_cube.h"
#include "scene/appearance_chunk.h"

#include <stdexcept>
#include <utility>

namespace vsplit::client {
namespace {

using test::Bytes;

constexpr std::uint32_t kSide = 512;
// Of attributes, which decoders of today pass over.
constexpr std::uint8_t kCodecToCome = 200;

Appearance appearance_of_torus()
{
    Appearance appearance;
    appearance.images.push_back({"fields", kSide, kSide, 3});
    appearance.images.push_back({"roughness", kSide, kSide, 3});
    Material material;
    material.base_color_texture.image = 0;
    material.metallic_roughness_texture.image = 1;
    appearance.materials.push_back(material);
    appearance.groups.push_back({"all", 0});
    return appearance;
}

// Noise, so that there is something to code.
Raster noise()
{
    Raster raster{kSide, kSide, 3, {}};
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < std::size_t{3} * kSide * kSide; ++i)
    {
        state = state * 1664525U + 1013904223U;
        raster.pixels.push_back(static_cast<std::uint8_t>(state >> 24U));
    }
    return raster;
}

std::vector<image::TextureChunk> texture_of(const Raster& raster, std::uint32_t image)
{
    image::TextureOptions options;
    options.image = image;
    options.psnr = 20.0;
    const auto encoded = image::encode_texture(raster, options);
    if (!encoded)
    {
        throw std::runtime_error(describe(encoded.error()));
    }
    return encoded->chunks;
}

class Inserter
{
public:
    explicit Inserter(test::StreamParts& parts) : parts_(parts) {}

    // Inserts a chunk before number `place` and returns its length.
    std::uint64_t insert(
        std::size_t place, proto::ChunkKind kind, const Bytes& contents, std::uint32_t tag = 0
    )
    {
        codec::ChunkInfo row = parts_.info.chunks[place - 1];
        row.kind = kind;
        row.codec = kind == proto::ChunkKind::Attributes ? kCodecToCome : 0;
        row.tag = tag;
        const auto at = static_cast<std::ptrdiff_t>(place);
        parts_.info.chunks.insert(parts_.info.chunks.begin() + at, row);
        parts_.chunks.insert(parts_.chunks.begin() + at, contents);
        return contents.size() + proto::kChunkChecksumBytes;
    }

private:
    test::StreamParts& parts_;
};

PaintedStream make()
{
    PaintedStream painted;
    test::StreamParts parts = test::take_apart(encoded_torus().file);
    Inserter inserter(parts);
    const auto appearance = scene::encode_appearance(appearance_of_torus());
    painted.appearance_bytes = inserter.insert(1, proto::ChunkKind::Appearance, appearance.value());
    std::size_t place = 2;
    for (const image::TextureChunk& chunk : texture_of(four_fields(kSide), 0))
    {
        painted.drawn_bytes +=
            inserter.insert(place++, proto::ChunkKind::Texture, chunk.payload, chunk.tag);
    }
    place += 3;
    for (const image::TextureChunk& chunk : texture_of(noise(), 1))
    {
        painted.idle_bytes +=
            inserter.insert(place++, proto::ChunkKind::Texture, chunk.payload, chunk.tag);
    }
    painted.stream.file = test::put_together(parts);
    painted.stream.info = codec::parse_stream_info(painted.stream.file).value();
    return painted;
}

}  // namespace

const PaintedStream& painted_torus()
{
    static const PaintedStream kStream = make();
    return kStream;
}

}  // namespace vsplit::client
